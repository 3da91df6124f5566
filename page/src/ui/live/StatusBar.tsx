// The line below the picture: how far it is, and what is under the mouse.
import type { JSX } from "preact";

import { count, num } from "../../data/number";
import type { Live } from "../../live/live";
import type { Pick } from "../../live/protocol";

export function StatusBar({ live }: { live: Live }): JSX.Element {
  const { main } = live;
  const [status, header, link] = [main.status.value, main.picture.value?.header, main.link.state.value];
  const connected = link.is === "open";
  const [samples, of] = [header?.samples ?? status?.samples ?? 0, header?.of ?? status?.of ?? 1];
  const state = !connected ? "offline" : live.paused.value ? "paused" : header?.done ? "done" : status?.state ?? "rendering";
  const words: Record<string, string> = {
    offline: "no connection", paused: "paused", rendering: samples === 0 ? "first light" : "rendering", done: "done", compiling: "building", error: "the scene has an error",
  };
  return (
    <div class="status" data-state={state}>
      <div class="progress" role="progressbar" aria-label="Samples" aria-valuemin={0} aria-valuemax={of} aria-valuenow={samples}><i style={{ width: `${(samples / Math.max(of, 1)) * 100}%` }} /></div>
      <p class="state"><i aria-hidden="true" /><b>{words[state]}</b>
        <span class="samples">{count(samples)} of {count(of)} {of === 1 ? "sample" : "samples"}</span>
        {header && <span class="time">{time(header.ms)}</span>}
        {header?.rays_per_s != null && header.rays_per_s > 0 && <span class="rate">{rate(header.rays_per_s)}</span>}
        {(status?.viewers ?? 1) > 1 && <span class="viewers">{status!.viewers} viewers</span>}
      </p>
      <Under live={live} />
    </div>
  );
}

function time(ms: number): string {
  return ms < 1000 ? `${Math.round(ms)} ms` : `${num(ms / 1000, 3)} s`;
}

function rate(perSecond: number): string {
  return perSecond >= 1e6 ? `${num(perSecond / 1e6, 3)} M rays/s` : `${num(perSecond / 1e3, 3)} k rays/s`;
}

/** What is under the mouse, else what was picked. */
function Under({ live }: { live: Live }): JSX.Element {
  const [hovered, picked] = [live.hovered.value, live.picked.value];
  const found = hovered ? hovered.found : picked;
  const pixel = hovered?.pixel ?? picked?.pixel;
  if (!pixel) return <p class="under quiet">click a pixel to see its rays</p>;
  return (
    <p class="under" data-pixel={pixel.join(",")}>
      <span class="at">({pixel.join(", ")})</span>
      {found?.rgb && <span class="read">{numbers(found, live.main.layer.value)}</span>}
      {found && <Object found={found} live={live} />}
    </p>
  );
}

/** The numbers of a pixel, with their unit. */
export function numbers({ rgb }: Pick, layer: string): string {
  const [a = 0, b = 0, c = 0] = rgb ?? [];
  switch (layer) {
    case "depth": return `${num(a)} m deep`;
    case "cost": return `${count(a)} primitives + ${count(b)} boxes tested`;
    case "rays": return `${num(a, 3)} rays per sample`;
    case "noise": return `luminance ${num(b, 3)} ± ${num(Math.sqrt(Math.max(0, c - b * b)), 3)} per sample`;
    case "id": return `object ${count(a)}`;
    case "uv": return `u ${num(a)}  v ${num(b)}`;
    default: return (rgb ?? []).map((x) => num(x, 3)).join("  ");
  }
}

function Object({ found, live }: { found: Pick; live: Live }): JSX.Element {
  if (found.object === null) return <span class="quiet">nothing</span>;
  const { form, light } = found;
  return (
    <span class="object">
      <b>{found.object}</b>
      {form ? <button type="button" title="Change this material" onClick={() => live.showForm(form)}>{found.material ?? "material"}</button> : found.material && <span>{found.material}</span>}
      {light && <button type="button" title="Change this light" onClick={() => live.showForm(light)}>light</button>}
      {found.t !== null && <span class="far">{num(found.t, 3)} m</span>}
    </span>
  );
}
