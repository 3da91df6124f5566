// Opens the page: reads the document inside it, restores the state of the address, mounts the views.
import { render } from "preact";

import { load, NothingToShow } from "./data/load";
import type { Viewer } from "./scene/viewer";
import { keepHash, readHash } from "./state/hash";
import { listen } from "./state/keys";
import { followTheme } from "./state/looks";
import { createStore, runPlayback, type Store } from "./state/store";
import "./style/base.css";
import "./style/layout.css";
import "./style/panels.css";
import { announce } from "./ui/announce";
import { App } from "./ui/App";

/** For the browser's console: the store and the 3D view. */
declare global {
  interface Window { durer?: { store: Store; viewer: Viewer | null } }
}

async function open(): Promise<void> {
  const host = document.getElementById("app")!;
  const holder = document.getElementById("durer-data");
  try {
    const page = await load(holder?.textContent ?? "");
    // The text has been read; a large one need not stay in memory.
    holder?.remove();
    const store = createStore(page);
    const [x, y] = page.trees[0]!.pixel;
    document.title = `${page.scene.name} (${x}, ${y}) – ray tree`;
    readHash(store, location.hash);
    followTheme(store.looks);
    keepHash(store);
    runPlayback(store);
    window.durer = { store, viewer: null };
    listen(store, () => window.durer!.viewer);
    announce(store);
    host.textContent = "";
    render(<App store={store} />, host);
  } catch (error) {
    if (!(error instanceof NothingToShow)) throw error;
    host.textContent = "";
    render(<p class="waiting" role="alert">{error.message}</p>, host);
  }
}

void open();
