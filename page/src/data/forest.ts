// A tree with what views ask of it again and again: children, sizes, letters, order.
import { luminance } from "./color";
import { asksLight, lookOf } from "./kinds";
import { subscript } from "./number";
import type { Node, Tree } from "./types";

/** A tree and its indices; ids of nodes are indices. */
export interface Grove {
  tree: Tree;
  nodes: Node[];
  /** Children in recorded order. */
  children: number[][];
  /** Nodes at and below each. */
  sizes: number[];
  /** What each subtree adds to the pixel, by luminance. */
  shares: number[];
  /** The largest absolute value in `shares`. */
  most: number;
  /** Letters of the slide: what the ray is called. */
  letters: string[];
  /** Number of the hit where the ray ends, counted in order; 0 if it ends nowhere. */
  hits: number[];
  /** Distance from the root in steps of the tree. */
  levels: number[];
  /** The largest of `levels`. */
  deepest: number;
}

export function grove(tree: Tree): Grove {
  const nodes = tree.nodes;
  const children: number[][] = nodes.map(() => []);
  const levels = nodes.map(() => 0);
  nodes.forEach((node, index) => {
    if (node.parent === null || !children[node.parent]) return;
    children[node.parent]!.push(index);
    levels[index] = (levels[node.parent] ?? 0) + 1;
  });
  const sizes = nodes.map(() => 1);
  // Rays that the page has no room for count where they are missed.
  const shares = nodes.map((node) => luminance(node.contribution) + (node.left_out ? luminance(node.left_out.contribution) : 0));
  for (let i = nodes.length - 1; i >= 0; i--) {
    const parent = nodes[i]!.parent;
    if (parent === null) continue;
    sizes[parent]! += sizes[i]!;
    shares[parent]! += shares[i]!;
  }
  const most = shares.reduce((a, b) => Math.max(a, Math.abs(b)), 0);
  const hits = numberHits(nodes);
  const deepest = levels.reduce((a, b) => Math.max(a, b), 0);
  return { tree, nodes, children, sizes, shares, most, letters: letters(nodes, children, hits), hits, levels, deepest };
}

function numberHits(nodes: Node[]): number[] {
  let next = 1;
  return nodes.map((node) => (node.point && !asksLight(node) ? next++ : 0));
}

/** As on the slide: L, R and T with the number of the hit they start from; several of a letter get a second index. */
function letters(nodes: Node[], children: number[][], hits: number[]): string[] {
  const names = nodes.map((node) => lookOf(node.kind).letter);
  children.forEach((below, parent) => {
    const letter = (child: number) => lookOf(nodes[child]!.kind).letter;
    const several = new Map<string, number>();
    below.forEach((child) => several.set(letter(child), (several.get(letter(child)) ?? 0) + 1));
    const seen = new Map<string, number>();
    below.forEach((child) => {
      const own = letter(child);
      const index = (seen.get(own) ?? 0) + 1;
      seen.set(own, index);
      const place = subscript(hits[parent] ?? 0);
      names[child] = (several.get(own) ?? 0) > 1 ? `${own}${place}.${subscript(index)}` : `${own}${place}`;
    });
  });
  return names;
}

/** The nodes from the root to this one. */
export function pathTo(g: Grove, id: number): number[] {
  const path: number[] = [];
  for (let at: number | null = id; at !== null && g.nodes[at]; at = g.nodes[at]!.parent) path.push(at);
  return path.reverse();
}

/** How children are put in order. */
export type Order = "recorded" | "contribution" | "size";

/** The children of a node in an order. */
export function sorted(g: Grove, id: number, order: Order): number[] {
  const below = g.children[id] ?? [];
  if (order === "recorded") return below;
  const by = (id: number) => Math.abs((order === "size" ? g.sizes : g.shares)[id]!);
  return [...below].sort((a, b) => by(b) - by(a) || a - b);
}

/** Rows of the outline: nodes whose ancestors are all open, depth first. */
export function rows(g: Grove, folded: ReadonlySet<number>, order: Order): number[] {
  const out: number[] = [];
  const open = g.nodes.flatMap((node, id) => (node.parent === null ? [id] : [])).reverse();
  while (open.length > 0) {
    const id = open.pop()!;
    out.push(id);
    if (folded.has(id)) continue;
    const below = sorted(g, id, order);
    for (let i = below.length - 1; i >= 0; i--) open.push(below[i]!);
  }
  return out;
}

/** What large trees show at first: the subtrees that add most, up to about this many rows; the rest is folded. */
export function firstFolds(g: Grove, most: number): Set<number> {
  const folded = new Set<number>();
  if (g.nodes.length <= most) return folded;
  g.children.forEach((below, id) => below.length > 0 && folded.add(id));
  // Open the subtrees that matter, largest share first.
  const byShare = g.children.map((_, id) => id).filter((id) => folded.has(id));
  byShare.sort((a, b) => g.levels[a]! - g.levels[b]! || Math.abs(g.shares[b]!) - Math.abs(g.shares[a]!));
  let shown = 1;
  for (const id of byShare) {
    const parent = g.nodes[id]!.parent;
    if (parent !== null && folded.has(parent)) continue;
    if (shown + g.children[id]!.length > most) continue;
    folded.delete(id);
    shown += g.children[id]!.length;
  }
  return folded;
}
