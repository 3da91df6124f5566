// Two trees of the same sample: which rays are new, gone or changed, with the numbers.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import { changes, verdict, type Fate, type Pair } from "../data/compare";
import { lookOf } from "../data/kinds";
import { num, percent } from "../data/number";
import { fateCss } from "../scene/fates";
import type { Rgb } from "../data/types";
import type { Store } from "../state/store";
import { Empty, Section, Swatch } from "./parts";

const WORDS: Record<Fate, string> = { same: "as before", changed: "changed", added: "new", removed: "gone" };
const SHOWN = 200;

export function Compare({ store }: { store: Store }): JSX.Element {
  const [a, b] = [store.g.value, store.rival.value];
  const only = useSignal<Fate | "all">("all");
  if (!store.page.other || !b) return <Empty>This sample was not traced the other way.</Empty>;
  const pairs = store.pairs.value;
  const counts = (fate: Fate): number => pairs.filter((pair) => pair.fate === fate).length;
  const list = changes(pairs, a, b).filter((pair) => only.value === "all" || pair.fate === only.value);
  const { share } = verdict(a, b);
  const more = share > 0 ? "adds" : "removes";
  const summary = a.tree.diff?.summary;
  return (
    <>
      <p class="lead">{summary ? <>With <code>{store.page.other.options}</code>: {summary}.</> : <>With <code>{store.page.other.options}</code> this sample {share === 0
        ? "keeps its value." : <>changes: it {more} <b>{percent(Math.abs(share))}</b> of it.</>}</>}</p>
      <table class="versus"><tbody>
        <tr><th scope="row">as traced</th><td><Swatch rgb={a.tree.rgb} /> {rgb(a.tree.rgb)}</td><td class="quiet">{a.nodes.length} rays</td></tr>
        <tr><th scope="row">the other way</th><td><Swatch rgb={b.tree.rgb} /> {rgb(b.tree.rgb)}</td><td class="quiet">{b.nodes.length} rays</td></tr>
      </tbody></table>
      <div class="fates" role="group" aria-label="Show only">
        {(["changed", "added", "removed", "same"] as Fate[]).map((fate) => (
          <button key={fate} type="button" aria-pressed={only.value === fate} disabled={fate === "same"} style={{ "--fate": fateCss(fate) }}
            onClick={() => (only.value = only.value === fate ? "all" : fate)}><i />{counts(fate)} {WORDS[fate]}</button>
        ))}
      </div>
      <Section title="Changes" note="those that matter most first">
        {list.length === 0 ? <Empty>No ray differs.</Empty> : (
          <ul class="changes">{list.slice(0, SHOWN).map((pair) => <Change key={`${pair.a} ${pair.b}`} store={store} pair={pair} />)}</ul>
        )}
        {list.length > SHOWN && <p class="note">and {list.length - SHOWN} more</p>}
      </Section>
    </>
  );
}

const rgb = (color: Rgb): string => color.map((x) => num(x, 4)).join("  ");

function Change({ store, pair }: { store: Store; pair: Pair }): JSX.Element {
  const [a, b] = [store.g.value, store.rival.value!];
  const [p, q] = [a.nodes[pair.a], b.nodes[pair.b]];
  const name = p ? a.letters[pair.a]! : b.letters[pair.b]!;
  const node = (p ?? q)!;
  const parent = q && !p && q.parent !== null ? store.pairs.value.find((other) => other.b === q.parent)?.a : undefined;
  const target = p ? pair.a : (parent ?? -1);
  const below = pair.fate === "removed" ? a.sizes[pair.a]! - 1 : pair.fate === "added" ? b.sizes[pair.b]! - 1 : 0;
  return (
    <li data-fate={pair.fate} style={{ "--fate": fateCss(pair.fate) }} class={target === store.selected.value && p ? "on" : ""}>
      <button type="button" onClick={() => target >= 0 && store.select(target)} onMouseEnter={() => (store.hovered.value = p ? pair.a : null)}
        onMouseLeave={() => (store.hovered.value = null)}>
        <i /><b>{name}</b> <span>{lookOf(node.kind).word}{node.object !== null ? `, ${node.object}` : node.light?.name ? ` to ${node.light.name}` : ""}{below > 0 && ` with ${below} below`}</span>
        <em>{WORDS[pair.fate]}</em>
      </button>
      <dl>
        {p && q ? pair.differs.slice(0, 4).map((key) => [<dt key={key}>{key}</dt>, <dd>{text(p[key as keyof typeof p])} → {text(q[key as keyof typeof q])}</dd>])
          : [<dt key="result">result</dt>, <dd>{rgb(node.result)}</dd>, <dt key="weight">throughput</dt>, <dd>{rgb(node.throughput)}</dd>]}
        <dt>pixel</dt><dd class={pair.change < 0 ? "less" : "more"}>{pair.change > 0 ? "+" : ""}{num(pair.change, 3)}</dd>
      </dl>
    </li>
  );
}

function text(value: unknown): string {
  if (typeof value === "number") return num(value);
  if (Array.isArray(value)) return value.map((x) => num(Number(x))).join("  ");
  return value === null || value === undefined ? "–" : String(value);
}
