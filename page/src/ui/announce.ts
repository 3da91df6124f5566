// What screen readers hear when the selection changes, until what `announce` returns is called.
import { effect } from "@preact/signals";

import { lookOf, stopOf } from "../data/kinds";
import { percent, share } from "../data/number";
import type { Store } from "../state/store";

export function announce(store: Store): () => void {
  let first = true;
  return effect(() => {
    const [g, node] = [store.g.value, store.node.value];
    if (first) {
      first = false;
      return;
    }
    const met = node.object ? `hits ${node.object}` : node.light ? `to ${node.light.name ?? "a light"}` : "";
    const stop = node.stop ? stopOf(node.stop).word : "";
    const adds = percent(share(node.contribution, g.tree.rgb));
    store.say([`${g.letters[node.id]}, ${lookOf(node.kind).word}`, met, stop, `adds ${adds}`].filter(Boolean).join(", "));
  });
}
