// The call stack of the recursion: what is open, what it has summed so far, and what happens next.
import type { JSX } from "preact";

import { narrate } from "../data/narrate";
import { tuple } from "../data/number";
import { stack, type Act, type March } from "../data/playback";
import type { Store } from "../state/store";
import { Choice, Empty, RayChip, Section, Swatch } from "./parts";

const ACTS: Record<Act, string> = { push: "sent", shade: "shaded", pop: "returned" };
const SPEEDS: [string, string][] = [["0.5", "½×"], ["2", "1×"], ["6", "3×"], ["20", "10×"], ["240", "fast"]];

export function PlayPanel({ store }: { store: Store }): JSX.Element {
  const at = store.step.value;
  return (
    <>
      <div class="rowed">
        <Choice<March> label="Order" value={store.march.value} options={[["recursion", "Recursion"], ["breadth", "Breadth"]]}
          onChange={(march) => { store.march.value = march; if (at !== null) store.go(0); }} />
        <Choice label="Speed" value={String(store.speed.value)} options={SPEEDS} onChange={(speed) => (store.speed.value = Number(speed))} />
        <label class="check"><input type="checkbox" checked={store.loop.value} onChange={(event) => (store.loop.value = event.currentTarget.checked)} /> loop</label>
      </div>
      {at === null ? <Empty>All rays are shown. Step or play, and the calls that are open stand here.</Empty> : <Calls store={store} at={at} />}
    </>
  );
}

function Calls({ store, at }: { store: Store; at: number }): JSX.Element {
  const [g, plot] = [store.g.value, store.plot.value];
  const step = plot.steps[at]!;
  const frames = stack(g, plot, at);
  const next = plot.steps.slice(at + 1, at + 5);
  return (
    <>
      <p class="story big">{narrate(g, step)}</p>
      <Section title="Call stack" note="innermost above">
        <ol class="calls">
          {frames.slice().reverse().map((frame, index) => (
            <li key={frame.node} class={index === 0 ? `now ${step.act}` : ""}>
              <RayChip store={store} id={frame.node} />
              <span class="act">{index === 0 ? ACTS[step.act] : "waits"}</span>
              <span class="sum">{frame.shaded ? <><Swatch rgb={frame.sum} /> {tuple(frame.sum, 3)}</> : "…"}</span>
            </li>
          ))}
        </ol>
      </Section>
      {next.length > 0 && (
        <Section title="Next">
          <ol class="next">{next.map((coming, index) => (
            <li key={index}><button type="button" onClick={() => store.go(at + 1 + index)}><b>{g.letters[coming.node]}</b> is {ACTS[coming.act]}</button></li>
          ))}</ol>
        </Section>
      )}
    </>
  );
}
