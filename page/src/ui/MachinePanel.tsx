// Duerer's machine: the picture on which the string is led, and what the machine has to say.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";

import { num } from "../data/number";
import type { Store } from "../state/store";
import { Section } from "./parts";

export function MachinePanel({ store }: { store: Store }): JSX.Element {
  const { picture } = store.page;
  const tree = store.g.value.tree;
  const own = tree.film ?? [tree.pixel[0] + 0.5, tree.pixel[1] + 0.5];
  const at = store.machineAt.value ?? own;
  const drawing = useSignal(false);
  useEffect(() => {
    if (!drawing.value) return;
    const timer = setInterval(() => {
      store.machineAt.value = [Math.random() * tree.width, Math.random() * tree.height];
    }, 40);
    return () => clearInterval(timer);
  }, [drawing.value]);
  const lead = (event: PointerEvent): void => {
    if (event.type === "pointermove" && event.buttons === 0) return;
    const box = (event.currentTarget as Element).getBoundingClientRect();
    const share = (x: number): number => Math.min(Math.max(x, 0), 0.9999);
    store.machineAt.value = [share((event.clientX - box.left) / box.width) * tree.width, share((event.clientY - box.top) / box.height) * tree.height];
  };
  const step = (event: KeyboardEvent): void => {
    const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!move) return;
    event.preventDefault();
    event.stopPropagation();
    const by = event.shiftKey ? 1 : tree.width / 64;
    store.machineAt.value = [Math.min(Math.max(at[0] + move[0]! * by, 0), tree.width - 0.01), Math.min(Math.max(at[1] + move[1]! * by, 0), tree.height - 0.01)];
  };
  const [px, py] = [Math.floor(at[0]), Math.floor(at[1])];
  return (
    <Section title="Dürer’s machine">
      <p class="lead">A string is fixed to an eyelet in the wall: the eye. Its other end is led to a point of the scene; where it goes through the frame, two threads are crossed, the string is let go, the paper is shut, and there goes a dot. Each pixel is one such string.</p>
      <div class="paper" style={{ aspectRatio: `${tree.width} / ${tree.height}` }} role="application" tabIndex={0} data-keys
        aria-label={`Picture; the string goes through pixel ${px}, ${py}. Arrow keys lead it.`}
        onPointerDown={(event) => { event.currentTarget.setPointerCapture(event.pointerId); lead(event); }} onPointerMove={lead} onKeyDown={step}>
        {picture?.png.startsWith("data:image/") ? <img src={picture.png} alt="" draggable={false} /> : <span class="empty">There is no picture in this page.</span>}
        <i class="across" style={{ top: `${(at[1] / tree.height) * 100}%` }} /><i class="up" style={{ left: `${(at[0] / tree.width) * 100}%` }} />
      </div>
      <p class="note">The string goes through pixel ({px}, {py}){px === tree.pixel[0] && py === tree.pixel[1] ? ", the one traced here" : ""}. {tree.width} × {tree.height} strings make the picture.</p>
      <div class="rowed">
        <button type="button" aria-pressed={drawing.value} onClick={() => (drawing.value = !drawing.value)}>{drawing.value ? "Stop drawing" : "Draw dots"}</button>
        <button type="button" onClick={() => { store.machineAt.value = null; }}>Back to the traced pixel</button>
        <button type="button" onClick={() => { window.durer?.viewer?.machine.wipe(); window.durer?.viewer?.invalidate(); }}>New paper</button>
      </div>
      <Touched store={store} />
    </Section>
  );
}

function Touched({ store }: { store: Store }): JSX.Element | null {
  const root = store.g.value.nodes[0]!;
  if (store.machineAt.value !== null) return null;
  if (!root.point) return <p class="note">This string meets nothing.</p>;
  return <p class="note">It touches <q>{root.object}</q> after {num(root.t)} m.</p>;
}
