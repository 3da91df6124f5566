// The ray tree: as on the lecture's slide, or as an outline; folded and sorted.
import type { JSX } from "preact";

import type { Order } from "../data/forest";
import { count } from "../data/number";
import type { Store, TreeStyle } from "../state/store";
import { Outline } from "./Outline";
import { Choice, LeftOutNote } from "./parts";
import { Slide } from "./Slide";

export function TreePanel({ store }: { store: Store }): JSX.Element {
  const g = store.g.value;
  const shown = store.shownRows.value.length;
  return (
    <div class="treepanel">
      <div class="rowed">
        <Choice<TreeStyle> label="Look of the tree" value={store.treeStyle.value} options={[["slide", "Slide"], ["outline", "Outline"]]}
          onChange={(style) => (store.treeStyle.value = style)} />
        <label class="sort">by <select value={store.order.value} aria-label="Order of the tree" onChange={(event) => (store.order.value = event.currentTarget.value as Order)}>
          <option value="recorded">recursion</option><option value="contribution">contribution</option><option value="size">rays</option>
        </select></label>
      </div>
      <LeftOutNote store={store} />
      {store.treeStyle.value === "slide" ? <Slide store={store} /> : <Outline store={store} />}
      <div class="tally">
        <span>{count(g.nodes.length)} {g.nodes.length === 1 ? "ray" : "rays"}{shown < g.nodes.length && `, ${count(shown)} shown`}</span>
        <button type="button" title="Fold all" onClick={() => store.foldAll(true)}>fold</button>
        <button type="button" title="Open all" onClick={() => store.foldAll(false)}>open</button>
      </div>
    </div>
  );
}
