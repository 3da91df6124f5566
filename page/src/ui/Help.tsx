// The help: keys, the mouse, and what the signs mean.
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { lookOf, STOPS } from "../data/kinds";
import type { Kind } from "../data/types";
import { HELP } from "../state/keys";
import type { Store } from "../state/store";
import { KindLine } from "./parts";

export function Help({ store }: { store: Store }): JSX.Element {
  const dialog = useRef<HTMLDialogElement>(null);
  const open = store.help.value;
  useEffect(() => {
    if (open && !dialog.current?.open) dialog.current?.showModal();
    if (!open) dialog.current?.close();
  }, [open]);
  const kinds = [...new Set(store.page.trees.flatMap((tree) => tree.nodes.map((node) => node.kind)))];
  const stops = [...new Set(store.page.trees.flatMap((tree) => tree.nodes.flatMap((node) => node.stop ?? [])))];
  return (
    <dialog class="help" ref={dialog} aria-labelledby="help-title" onClose={() => (store.help.value = false)}
      onClick={(event) => event.target === dialog.current && (store.help.value = false)}>
      {open && (
        <div class="sheet">
          <header><h2 id="help-title">How to read and steer</h2>
            <button type="button" onClick={() => (store.help.value = false)}>Close</button></header>
          <Legend store={store} kinds={kinds} stops={stops} />
          <div class="keys">
            {HELP.map((group) => (
              <section key={group.title}><h3>{group.title}</h3>
                <dl>{group.keys.map((key) => [<dt key={key.keys}>{key.keys.split(" ").map((k) => k === "…" ? " … " : <kbd key={k}>{k}</kbd>)}</dt>, <dd>{key.does}</dd>])}</dl>
              </section>
            ))}
            <section><h3>Mouse and fingers</h3>
              <dl><dt>drag, one finger</dt><dd>turn</dd><dt>right drag, two fingers</dt><dd>shift</dd>
                <dt>wheel, pinch</dt><dd>nearer, farther</dd><dt>click, tap</dt><dd>choose a ray</dd></dl>
            </section>
          </div>
        </div>
      )}
    </dialog>
  );
}

function Legend({ store, kinds, stops }: { store: Store; kinds: Kind[]; stops: string[] }): JSX.Element {
  return (
    <div class="legend">
      <ul>{kinds.map((kind) => <li key={kind}><KindLine kind={kind} store={store} /><b>{lookOf(kind).letter}</b> {lookOf(kind).word}</li>)}
        <li><b>N</b> hit, with its normal</li></ul>
      <ul>{stops.map((stop) => <li key={stop}><b class="sign">{STOPS[stop]?.sign ?? "?"}</b> {STOPS[stop]?.word ?? stop}: {STOPS[stop]?.says}</li>)}</ul>
    </div>
  );
}
