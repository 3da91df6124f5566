// The tree as rows. Only the rows in sight exist, so that ten thousand rays scroll like ten.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { cssOf, isUntraced, lookOf } from "../data/kinds";
import { belowRay } from "../data/missing";
import { count, percent, share } from "../data/number";
import type { Node } from "../data/types";
import type { Store } from "../state/store";
import { Bar, StopBadge } from "./parts";

const ROW = 30;

export function Outline({ store }: { store: Store }): JSX.Element {
  const list = useRef<HTMLDivElement>(null);
  const top = useSignal(0);
  const height = useSignal(600);
  const rows = store.shownRows.value;
  const selected = store.selected.value;
  useEffect(() => {
    const element = list.current!;
    const observer = new ResizeObserver(() => (height.value = element.clientHeight));
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    const element = list.current!;
    const y = rows.indexOf(selected) * ROW;
    if (y < element.scrollTop) element.scrollTop = y - ROW;
    else if (y + ROW > element.scrollTop + element.clientHeight) element.scrollTop = y + 2 * ROW - element.clientHeight;
  }, [selected, rows]);
  const first = Math.max(0, Math.floor(top.value / ROW) - 4);
  const last = Math.min(rows.length, Math.ceil((top.value + height.value) / ROW) + 4);
  return (
    <div class="outline" role="tree" aria-label="Rays" tabIndex={0} ref={list} aria-activedescendant={`row-${selected}`}
      onScroll={(event) => (top.value = event.currentTarget.scrollTop)}>
      <div style={{ height: `${rows.length * ROW}px` }}>
        <div style={{ transform: `translateY(${first * ROW}px)` }}>
          {rows.slice(first, last).map((id) => <Row key={id} store={store} id={id} />)}
        </div>
      </div>
    </div>
  );
}

function Row({ store, id }: { store: Store; id: number }): JSX.Element {
  const g = store.g.value;
  const node = g.nodes[id]!;
  const branches = g.children[id]!.length > 0;
  const closed = store.folded.value.has(id);
  const part = g.most > 0 ? g.shares[id]! / g.most : 0;
  const own = share(node.contribution, g.tree.rgb);
  const classes = ["row", id === store.selected.value && "on", id === store.hovered.value && "hover", isUntraced(node) && "untraced"];
  return (
    <div
      role="treeitem" id={`row-${id}`} data-node={id} class={classes.filter(Boolean).join(" ")} style={{ height: `${ROW}px` }}
      aria-level={g.levels[id]! + 1} aria-selected={id === store.selected.value} {...(branches && { "aria-expanded": !closed })}
      onClick={() => store.select(id)} onDblClick={() => store.fold(id, !closed)}
      onMouseEnter={() => (store.hovered.value = id)} onMouseLeave={() => (store.hovered.value = null)}
    >
      <span class="indent" style={{ width: `${g.levels[id]! * Math.min(13, 110 / Math.max(g.deepest, 1))}px` }} />
      <span class={`turn ${branches ? "" : "leaf"} ${closed ? "" : "open"}`} aria-hidden="true"
        onClick={(event) => { event.stopPropagation(); store.fold(id, !closed); }}>{branches ? "▸" : ""}</span>
      <span class="letter" style={{ "--kind": cssOf(node.kind, store.palette.value) }}><i />{g.letters[id]}</span>
      <span class="name">{nameOf(node)}{closed && <em> +{g.sizes[id]! - 1}</em>}{node.left_out && <em class="missing" title={belowRay(node.left_out, g.tree)}> {count(node.left_out.rays)} left out</em>}</span>
      {node.stop && <StopBadge stop={node.stop} brief />}
      <Bar share={part} label={`${percent(own)} of the sample itself`} />
    </div>
  );
}

/** What the ray met, briefly. */
function nameOf(node: Node): string {
  if (node.light) return `to ${node.light.name ?? `light ${node.light.index}`}`;
  if (node.object !== null) return node.object;
  if (isUntraced(node)) return `${lookOf(node.kind).word}, not traced`;
  return "the surroundings";
}
