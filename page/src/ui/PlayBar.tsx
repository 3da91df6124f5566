// Playback under the 3D view: step, play, a slider, and a sentence for each step.
import type { JSX } from "preact";

import { narrate } from "../data/narrate";
import type { Store } from "../state/store";

export function PlayBar({ store }: { store: Store }): JSX.Element {
  const { steps } = store.plot.value;
  const at = store.step.value;
  const go = (to: number | null): void => {
    store.playing.value = false;
    store.go(to);
  };
  return (
    <div class="playbar">
      <div class="controls" role="group" aria-label="Playback">
        <button type="button" title="All rays at once (0)" aria-pressed={at === null} onClick={() => go(null)}>All</button>
        <button type="button" title="Step back (,)" aria-label="Step back" onClick={() => go(at === null ? steps.length - 1 : at - 1)}><Icon d="M11 2v12L3 8zM2 2h1.6v12H2z" /></button>
        <button type="button" class="play" title="Play, pause (Space)" aria-label={store.playing.value ? "Pause" : "Play"}
          onClick={() => (store.playing.value = !store.playing.value)}>
          <Icon d={store.playing.value ? "M3 2h3.6v12H3zM9.4 2H13v12H9.4z" : "M3 1.5v13L14 8z"} />
        </button>
        <button type="button" title="Step forward (.)" aria-label="Step forward" onClick={() => go(at === null ? 0 : at + 1)}><Icon d="M5 2v12l8-6zM12.4 2H14v12h-1.6z" /></button>
        <input type="range" min="0" max={steps.length - 1} value={at ?? steps.length - 1} aria-label="Step of the recursion"
          aria-valuetext={at === null ? "all rays" : `step ${at + 1} of ${steps.length}`}
          onInput={(event) => go(Number(event.currentTarget.value))} />
        <output>{at === null ? `${steps.length} steps` : `${at + 1} / ${steps.length}`}</output>
      </div>
      <p class="story">{at === null ? <span class="quiet">Press play to see how the rays were followed, one after another.</span> : narrate(store.g.value, steps[at]!)}</p>
    </div>
  );
}

function Icon({ d }: { d: string }): JSX.Element {
  return <svg width="16" height="16" viewBox="0 0 16 16" aria-hidden="true"><path d={d} fill="currentColor" /></svg>;
}
