// All about one ray: what it is, the formulas with its numbers, and every recorded fact.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import { facts } from "../data/facts";
import { pathTo } from "../data/forest";
import { formulas, type Formula, type Term } from "../data/formula";
import { isUntraced, lookOf, stopOf } from "../data/kinds";
import { belowRay } from "../data/missing";
import { num, percent, share } from "../data/number";
import { unitTest } from "../data/snippet";
import type { Store } from "../state/store";
import { copy } from "./clipboard";
import { KindLine, RayChip, StopBadge, Swatch } from "./parts";

export function Inspector({ store }: { store: Store }): JSX.Element {
  const [g, node] = [store.g.value, store.node.value];
  const path = pathTo(g, node.id);
  return (
    <article class="inspector" data-node={node.id}>
      <nav class="path" aria-label="Way from the eye">
        {path.map((id, index) => <span key={id}>{index > 0 && <i aria-hidden="true">›</i>}<RayChip store={store} id={id} /></span>)}
      </nav>
      <header>
        <h2><KindLine kind={node.kind} store={store} /> <b>{g.letters[node.id]}</b> {lookOf(node.kind).word}</h2>
        <p class="what">{met(node)}</p>
        <p class="values">
          <Swatch rgb={node.result} /> <span>brings {node.result.map((x) => num(x, 3)).join("  ")}</span>
          {node.stop && <StopBadge stop={node.stop} />}
        </p>
        <p class="adds">{adds(store)}</p>
        {node.left_out && <p class="missing">{belowRay(node.left_out, g.tree)}</p>}
      </header>
      <Actions store={store} />
      {g.children[node.id]!.length > 0 && (
        <p class="below"><span>followed by</span> {g.children[node.id]!.slice(0, 40).map((id) => <RayChip key={id} store={store} id={id} plain />)}</p>
      )}
      <div class="formulas">{formulas(g, node).map((formula) => <FormulaCard key={formula.title} formula={formula} store={store} />)}</div>
      <div class="records">
        {facts(node).map((group) => (
          <details key={group.title} open={group.open}>
            <summary>{group.title}</summary>
            <dl>{group.facts.map((fact) => [<dt key={fact.name}>{fact.name}</dt>,
              <dd data-fact={fact.name}>{fact.rgb && <Swatch rgb={fact.rgb} />}{fact.text}{fact.unit && <small> {fact.unit}</small>}</dd>])}</dl>
          </details>
        ))}
      </div>
    </article>
  );
}

function met(node: Store["node"]["value"]): JSX.Element {
  if (isUntraced(node)) return <>not traced: {stopOf(node.stop!).says}</>;
  if (node.light) {
    const name = node.light.name ?? `light ${node.light.index}`;
    if (node.light.visible) return <>reaches <q>{name}</q></>;
    return <>to <q>{name}</q>, stopped{node.blocker ? <> by <q>{node.blocker}</q></> : ""}</>;
  }
  if (node.object !== null) {
    return <>hits <q>{node.object}</q> {node.side === "inside" ? "from inside " : ""}after {num(node.t)} m</>;
  }
  return <>leaves the scene</>;
}

function adds(store: Store): string {
  const [g, node] = [store.g.value, store.node.value];
  const own = percent(share(node.contribution, g.tree.rgb));
  const all = percent(share(g.tree.rgb, g.tree.rgb) === 0 ? 0 : g.shares[node.id]! / lum(g.tree.rgb));
  if (g.children[node.id]!.length === 0 && !node.left_out) return `adds ${own} of the sample`;
  return `adds ${own} of the sample itself, ${all} with all that follow`;
}

const lum = ([r, g, b]: [number, number, number]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b;

function Actions({ store }: { store: Store }): JSX.Element {
  const done = useSignal("");
  const give = async (what: string, text: string): Promise<void> => {
    done.value = (await copy(text)) ? `${what} copied` : `${what}: the browser does not let the page copy`;
    store.say(done.value);
    setTimeout(() => (done.value = ""), 2500);
  };
  const node = store.node.value;
  return (
    <div class="actions">
      <button type="button" onClick={() => give("JSON", JSON.stringify(store.page.trees[store.treeIndex.value]!.nodes[node.id], null, 2))}>Copy JSON</button>
      <button type="button" onClick={() => give("Unit test", unitTest(store.g.value.tree, node))}>Make a unit test</button>
      <button type="button" onClick={() => give("Link", location.href)}>Copy link</button>
      <span class="done" role="status">{done.value}</span>
    </div>
  );
}

function FormulaCard({ formula, store }: { formula: Formula; store: Store }): JSX.Element {
  return (
    <section class="formula">
      <h3>{formula.title}</h3>
      {formula.lines.map((line, index) => <p key={index}>{line.map((term, i) => <TermView key={i} term={term} store={store} />)}</p>)}
      {formula.check && (
        <p class={`check ${formula.check.agrees ? "agrees" : "differs"}`}><b aria-hidden="true">{formula.check.agrees ? "✓" : "≠"}</b> {formula.check.text}</p>
      )}
    </section>
  );
}

function TermView({ term, store }: { term: Term; store: Store }): JSX.Element {
  if (term.node !== undefined) return <RayChip store={store} id={term.node} plain />;
  if (term.as === "symbol") return <var>{term.text}</var>;
  if (term.as === "text") return <span>{term.text}</span>;
  return <span class="n">{term.rgb && <Swatch rgb={term.rgb} />}{term.text}</span>;
}
