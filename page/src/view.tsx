// Opens the live page: connects to the program that served it and mounts the views.
import { effect } from "@preact/signals";
import { render } from "preact";

import { listen } from "./live/keys";
import { createLive, type Live } from "./live/live";
import type { Socket } from "./live/link";
import { announce } from "./ui/announce";
import { followTheme } from "./state/looks";
import "./style/base.css";
import "./style/layout.css";
import "./style/panels.css";
import "./style/live.css";
import { LiveApp } from "./ui/live/LiveApp";

/** For the browser's console. */
declare global {
  interface Window { durerLive?: Live }
}

/** Where the session is remembered, for the page that is opened again in the same tab. */
const PLACE = "durer-session";

function open(): void {
  const token = new URLSearchParams(location.search).get("token") ?? "";
  const address = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/socket?token=${encodeURIComponent(token)}`;
  const remembered = JSON.parse(sessionStorage.getItem(PLACE) ?? "null") as { token: string; session: string } | null;
  const live = createLive((query) => new WebSocket(address + query) as Socket, { session: remembered?.token === token ? remembered.session : null });
  window.durerLive = live;
  followTheme(live.looks);
  listen(live, () => window.durer?.viewer ?? null);
  effect(() => {
    if (live.main.link.state.value.is === "open") sessionStorage.setItem(PLACE, JSON.stringify({ token, session: live.main.link.session }));
  });
  effect(() => {
    document.title = `${live.main.scene.value?.name ?? "…"} – durer`;
  });
  let silence: (() => void) | undefined;
  effect(() => {
    silence?.();
    const store = live.rays.store.value;
    silence = store ? announce(store) : undefined;
  });
  const host = document.getElementById("app")!;
  host.textContent = "";
  render(<LiveApp live={live} />, host);
}

open();
