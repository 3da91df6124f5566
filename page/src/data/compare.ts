// Two trees of the same sample side by side: which rays are new, gone or changed.
import { luminance } from "./color";
import type { Grove } from "./forest";
import type { Diff, Node, Rgb } from "./types";

export type Fate = "same" | "changed" | "added" | "removed";

export interface Pair {
  fate: Fate;
  /** Node of the first tree, or -1. */
  a: number;
  /** Node of the second tree, or -1. */
  b: number;
  depth: number;
  /** What of the ray differs. */
  differs: string[];
  /** Change of what the subtree adds to the pixel, by luminance. */
  change: number;
}

/** Aligns from the roots. If the program has said which rays belong together and what differs, that counts; else children
 * are paired by kind, light and their place among their like. */
export function compare(a: Grove, b: Grove, diff?: Diff | null): Pair[] {
  const pairs: Pair[] = [];
  const told = diff?.pairs ? new Map(diff.pairs) : null;
  const keys = new Map((diff?.changed ?? []).map((change) => [change.before, change.keys]));
  const [removed, added] = [new Set(diff?.removed), new Set(diff?.added)];
  const open: [number, number][] = [[a.nodes.length ? 0 : -1, b.nodes.length ? 0 : -1]];
  while (open.length > 0) {
    const [x, y] = open.pop()!;
    const found = pair(a, b, x, y);
    const differs = keys.get(x) ?? [];
    // A ray that the other way gives up before it is traced has a partner, but is gone.
    const fate = removed.has(x) ? "removed" : added.has(y) ? "added" : differs.length > 0 ? "changed" : "same";
    pairs.push(told && x >= 0 && y >= 0 ? { ...found, differs, fate } : found);
    const [xs, ys] = [x < 0 ? [] : a.children[x]!, y < 0 ? [] : b.children[y]!];
    const below = told ? paired(xs, ys, told) : align(xs, ys, a, b);
    for (let i = below.length - 1; i >= 0; i--) open.push(below[i]!);
  }
  return pairs;
}

function paired(xs: number[], ys: number[], told: Map<number, number>): [number, number][] {
  const taken = new Set(xs.map((x) => told.get(x)));
  const both = xs.map((x): [number, number] => [x, told.get(x) ?? -1]);
  return [...both, ...ys.filter((y) => !taken.has(y)).map((y): [number, number] => [-1, y])];
}

function align(xs: number[], ys: number[], a: Grove, b: Grove): [number, number][] {
  const keyed = (ids: number[], g: Grove): Map<string, number> => {
    const seen = new Map<string, number>();
    return new Map(ids.map((id) => {
      const node = g.nodes[id]!;
      const own = `${node.kind} ${node.light?.name ?? node.light?.index ?? ""}`;
      const place = seen.get(own) ?? 0;
      seen.set(own, place + 1);
      return [`${own} ${place}`, id];
    }));
  };
  const [left, right] = [keyed(xs, a), keyed(ys, b)];
  const both: [number, number][] = [...left].map(([key, id]) => [id, right.get(key) ?? -1]);
  const rest: [number, number][] = [...right].filter(([key]) => !left.has(key)).map(([, id]) => [-1, id]);
  return [...both, ...rest];
}

function pair(a: Grove, b: Grove, x: number, y: number): Pair {
  const [share, other] = [x < 0 ? 0 : a.shares[x]!, y < 0 ? 0 : b.shares[y]!];
  const depth = x < 0 ? b.levels[y]! : a.levels[x]!;
  const base = { a: x, b: y, depth, change: other - share };
  if (x < 0) return { ...base, fate: "added", differs: [] };
  if (y < 0) return { ...base, fate: "removed", differs: [] };
  const differs = differences(a.nodes[x]!, b.nodes[y]!);
  return { ...base, fate: differs.length > 0 ? "changed" : "same", differs };
}

const near = (p: number, q: number): boolean => Object.is(p, q) || Math.abs(p - q) <= 1e-6 * (Math.abs(p) + Math.abs(q));
const nearRgb = (p: Rgb, q: Rgb): boolean => p.every((x, i) => near(x, q[i]!));

function differences(p: Node, q: Node): string[] {
  const out: string[] = [];
  if (p.object !== q.object) out.push("object");
  if ((p.t === null) !== (q.t === null) || (p.t !== null && q.t !== null && !near(p.t, q.t))) out.push("t");
  if (!p.direction.every((x, i) => Math.abs(x - q.direction[i]!) < 1e-5)) out.push("direction");
  for (const key of ["weight", "throughput", "local", "contribution", "result"] as const) {
    if (!nearRgb(p[key], q[key])) out.push(key);
  }
  if (p.stop !== q.stop) out.push("stop");
  if (p.blocker !== q.blocker) out.push("blocker");
  return out;
}

/** Rays that differ, those that change the pixel most first. A subtree that is new or gone counts by its first ray. */
export function changes(pairs: Pair[], a: Grove, b: Grove): Pair[] {
  const removed = new Set(pairs.flatMap((p) => (p.fate === "removed" ? [p.a] : [])));
  const added = new Set(pairs.flatMap((p) => (p.fate === "added" ? [p.b] : [])));
  const isTop = (p: Pair): boolean => {
    if (p.fate === "removed") return !removed.has(a.nodes[p.a]!.parent ?? -1);
    if (p.fate === "added") return !added.has(b.nodes[p.b]!.parent ?? -1);
    return p.fate === "changed";
  };
  return pairs.filter(isTop).sort((p, q) => Math.abs(q.change) - Math.abs(p.change) || p.a - q.a);
}

/** One sentence on what the change does to the pixel. */
export function verdict(a: Grove, b: Grove): { before: number; after: number; share: number } {
  const [before, after] = [luminance(a.tree.rgb), luminance(b.tree.rgb)];
  return { before, after, share: before > 0 ? (after - before) / before : 0 };
}
