// Colours of rays that are new, gone or changed, and the lines of those that only the other tree has.
import type { Grove } from "../data/forest";
import type { Fate, Pair } from "../data/compare";
import type { Node } from "../data/types";
import type { Line } from "./fatlines";
import type { Ghosts } from "./ghosts";
import { lines, type Style } from "./rays";
import type { Space } from "./space";

/** After Okabe and Ito 2008, so that everybody can tell them apart. */
export const FATES: Record<Fate, [number, number, number]> = {
  same: [0.62, 0.62, 0.62],
  changed: [0.8, 0.475, 0.655],
  added: [0, 0.62, 0.45],
  removed: [0.835, 0.369, 0],
};

export function fateCss(fate: Fate): string {
  return `rgb(${FATES[fate].map((x) => Math.round(255 * x)).join(" ")})`;
}

/** Colours for the first tree. */
export function fateInk(pairs: Pair[]): (node: Node) => [number, number, number] | null {
  const fates = new Map(pairs.filter((pair) => pair.a >= 0).map((pair) => [pair.a, pair.fate]));
  return (node) => FATES[fates.get(node.id) ?? "same"];
}

/** Rays of the second tree that the first one has not, or has elsewhere. */
export function rivalLines(rival: Grove, pairs: Pair[], space: Space, ghosts: Ghosts, style: Style): Line[] {
  const shown = new Map<number, Fate>();
  for (const pair of pairs) {
    const moved = pair.differs.includes("direction") || pair.differs.includes("t");
    if (pair.fate === "added" || (pair.fate === "changed" && moved)) shown.set(pair.b, pair.fate);
  }
  const ink = (node: Node): [number, number, number] => FATES[shown.get(node.id) ?? "same"];
  return lines(rival, null, space, ghosts, { ...style, ink }).filter((line) => shown.has(line.node));
}
