// The 3D view with its tools above and the playback below.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

import type { Look } from "../scene/viewer";
import { Viewer } from "../scene/viewer";
import type { Store } from "../state/store";
import { PlayBar } from "./PlayBar";

const VIEWS: [Look, string, string][] = [
  ["all", "All", "All of the rays (A)"],
  ["eye", "Eye", "Through the eye of the picture (E)"],
  ["hit", "Hit", "The chosen ray’s hit (Enter)"],
  ["plane", "Plane", "The plane of incidence, from the side (P)"],
];

export function Stage({ store }: { store: Store }): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  const layer = useRef<HTMLDivElement>(null);
  const viewer = useRef<Viewer | null>(null);
  const failed = useSignal("");
  useEffect(() => {
    try {
      viewer.current = new Viewer(canvas.current!, layer.current!, store);
      window.durer = { store, viewer: viewer.current };
    } catch (error) {
      failed.value = `There is no 3D view: this browser offers no WebGL. (${String(error)})`;
    }
    return () => viewer.current?.dispose();
  }, []);
  const label = `3D view of ${store.page.scene.name || "the scene"} with the rays; chosen: ${store.g.value.letters[store.node.value.id]}. Keys: W S Q Z J L I K, plus and minus.`;
  return (
    <>
      <div class="view">
        <canvas ref={canvas} tabIndex={0} role="application" aria-label={label} />
        <div class="marks" ref={layer} aria-hidden="true" />
        {failed.value && <p class="empty failed" role="alert">{failed.value}</p>}
        <div class="tools" role="toolbar" aria-label="View">
          {VIEWS.map(([look, word, title]) => (
            <button key={look} type="button" title={title} onClick={() => viewer.current?.look(look)}>{word}</button>
          ))}
          <button type="button" title="Sit on the ray; the wheel moves along it (G)" aria-pressed={store.sitting.value}
            onClick={() => (store.sitting.value = !store.sitting.value)}>Ride</button>
          {store.page.trees.length > 1 && (
            <button type="button" title="The rays of all samples (B)" aria-pressed={store.bundle.value}
              onClick={() => (store.bundle.value = !store.bundle.value)}>Bundle</button>
          )}
          <Look3d viewer={() => viewer.current} />
        </div>
      </div>
      <PlayBar store={store} />
    </>
  );
}

/** How strong the ghosts are, and where they are cut open. */
function Look3d({ viewer }: { viewer: () => Viewer | null }): JSX.Element {
  const axis = useSignal<"none" | "x" | "y" | "z" | "view">("none");
  const share = useSignal(0.5);
  const cut = (): void => viewer()?.section(axis.value, share.value);
  return (
    <details class="menu">
      <summary title="Ghosts and section plane">Scene</summary>
      <div class="drop">
        <label>Ghosts
          <input type="range" min="0" max="1" step="0.02" value="0.3"
            onInput={(event) => { viewer()?.ghosts.strength(Number(event.currentTarget.value)); viewer()?.invalidate(); }} />
        </label>
        <label>Cut along
          <select value={axis.value} onChange={(event) => { axis.value = event.currentTarget.value as typeof axis.value; cut(); }}>
            <option value="none">nothing</option><option value="view">the view</option>
            <option value="x">x</option><option value="y">y</option><option value="z">z</option>
          </select>
        </label>
        <label>at
          <input type="range" min="0" max="1" step="0.005" value={share.value} disabled={axis.value === "none"}
            onInput={(event) => { share.value = Number(event.currentTarget.value); cut(); }} />
        </label>
      </div>
    </details>
  );
}
