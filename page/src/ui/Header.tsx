// The line above all: what was traced, its colour, the samples, and how the page looks.
import type { JSX } from "preact";

import { count, num, tuple } from "../data/number";
import type { Looks } from "../state/looks";
import type { Store } from "../state/store";
import { Swatch } from "./parts";

export function Header({ store }: { store: Store }): JSX.Element {
  const tree = store.g.value.tree;
  return (
    <header class="header">
      <h1>{store.page.scene.name || tree.scene}</h1>
      <p class="facts">
        <span><span class="wide-only">pixel </span>{tuple(tree.pixel, 6)}</span>
        <span class="wide-only">{tree.integrator}</span>
        <span class="wide-only">{count(tree.nodes.length)}{tree.left_out && ` of ${count(tree.nodes.length + tree.left_out.rays)}`} {tree.nodes.length === 1 ? "ray" : "rays"}</span>
        <span class="value"><Swatch rgb={tree.rgb} /><span class="wide-only">{tree.rgb.map((x) => num(x, 3)).join("  ")}</span></span>
      </p>
      <SamplePicker store={store} />
      <LookButtons looks={store.looks} />
    </header>
  );
}

/** Colours, light and help. */
export function LookButtons({ looks }: { looks: Looks }): JSX.Element {
  return (
    <div class="looks">
      <button type="button" aria-pressed={looks.palette.value === "safe"} title="Colours for the colour-blind (C)"
        onClick={() => (looks.palette.value = looks.palette.value === "safe" ? "lecture" : "safe")}><Drops /><span class="hidden">Colours for the colour-blind</span></button>
      <button type="button" aria-pressed={looks.dark.value} title="Light or dark (D)"
        onClick={() => (looks.theme.value = looks.dark.value ? "light" : "dark")}><Moon /><span class="hidden">Dark</span></button>
      <button type="button" title="Help (?)" onClick={() => (looks.help.value = true)}>?<span class="hidden">Help</span></button>
    </div>
  );
}

export function SamplePicker({ store }: { store: Store }): JSX.Element | null {
  const trees = store.page.trees;
  if (trees.length < 2) return null;
  const at = store.treeIndex.value;
  return (
    <div class="picker">
      <button type="button" title="Previous sample ([)" disabled={at === 0} onClick={() => store.chooseTree(at - 1)}>‹</button>
      <label>
        <span class="hidden">Sample</span>
        <select value={at} onChange={(event) => store.chooseTree(Number(event.currentTarget.value))}>
          {trees.map((tree, index) => <option key={index} value={index}>sample {tree.sample}</option>)}
        </select>
      </label>
      <button type="button" title="Next sample (])" disabled={at === trees.length - 1} onClick={() => store.chooseTree(at + 1)}>›</button>
    </div>
  );
}

function Drops(): JSX.Element {
  return (
    <svg width="18" height="14" aria-hidden="true">
      <circle cx="5.5" cy="7" r="4.5" fill="#d55e00" /><circle cx="12.5" cy="7" r="4.5" fill="#0072b2" fill-opacity=".85" />
    </svg>
  );
}

function Moon(): JSX.Element {
  return <svg width="15" height="15" viewBox="0 0 16 16" aria-hidden="true"><path d="M8 1a7 7 0 1 0 0 14z" fill="currentColor" /><circle cx="8" cy="8" r="6.6" fill="none" stroke="currentColor" stroke-width="1.4" /></svg>;
}
