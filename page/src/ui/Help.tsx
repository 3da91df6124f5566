// The help: keys, the mouse, and what the signs mean.
import type { ComponentChildren, JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { lookOf, STOPS } from "../data/kinds";
import { HELP, type Key } from "../state/keys";
import type { Looks } from "../state/looks";
import type { Store } from "../state/store";
import { KindLine } from "./parts";

export function Help({ store }: { store: Store }): JSX.Element {
  return <HelpSheet looks={store.looks} groups={HELP} hands={HANDS}><Legend store={store} /></HelpSheet>;
}

const HANDS: [string, string][] = [
  ["drag, one finger", "turn"], ["right drag, two fingers", "shift"], ["wheel, pinch", "nearer, farther"], ["click, tap", "choose a ray"],
];

/** Keys, what mouse and fingers do, and before them what the signs mean. */
export function HelpSheet({ looks, groups, hands, children }: {
  looks: Looks; groups: { title: string; keys: Key[] }[]; hands: [string, string][]; children: ComponentChildren;
}): JSX.Element {
  const dialog = useRef<HTMLDialogElement>(null);
  const open = looks.help.value;
  useEffect(() => {
    if (open && !dialog.current?.open) dialog.current?.showModal();
    if (!open) dialog.current?.close();
  }, [open]);
  return (
    <dialog class="help" ref={dialog} aria-labelledby="help-title" onClose={() => (looks.help.value = false)}
      onClick={(event) => event.target === dialog.current && (looks.help.value = false)}>
      {open && (
        <div class="sheet">
          <header><h2 id="help-title">How to read and steer</h2>
            <button type="button" onClick={() => (looks.help.value = false)}>Close</button></header>
          {children}
          <div class="keys">
            {groups.map((group) => (
              <section key={group.title}><h3>{group.title}</h3>
                <dl>{group.keys.map((key) => [<dt key={key.keys}>{key.keys.split(" ").map((k) => k === "…" ? " … " : <kbd key={k}>{k}</kbd>)}</dt>, <dd>{key.does}</dd>])}</dl>
              </section>
            ))}
            <section><h3>Mouse and fingers</h3>
              <dl>{hands.map(([what, does]) => [<dt key={what}>{what}</dt>, <dd>{does}</dd>])}</dl>
            </section>
          </div>
        </div>
      )}
    </dialog>
  );
}

export function Legend({ store }: { store: Store }): JSX.Element {
  const kinds = [...new Set(store.page.trees.flatMap((tree) => tree.nodes.map((node) => node.kind)))];
  const stops = [...new Set(store.page.trees.flatMap((tree) => tree.nodes.flatMap((node) => node.stop ?? [])))];
  return (
    <div class="legend">
      <ul>{kinds.map((kind) => <li key={kind}><KindLine kind={kind} store={store} /><b>{lookOf(kind).letter}</b> {lookOf(kind).word}</li>)}
        <li><b>N</b> hit, with its normal</li></ul>
      <ul>{stops.map((stop) => <li key={stop}><b class="sign">{STOPS[stop]?.sign ?? "?"}</b> {STOPS[stop]?.word ?? stop}: {STOPS[stop]?.says}</li>)}</ul>
    </div>
  );
}
