// Places of the slide's tree: the eye at the top, leaves side by side, parents in the middle over their children.
import { sorted, type Grove, type Order } from "./forest";

export interface Placed { id: number; x: number; y: number }

export interface Layout {
  placed: Placed[];
  /** Index in `placed` by node, -1 for folded ones. */
  at: Int32Array;
  width: number;
  height: number;
}

/** Steps between leaves and between levels, in units of the drawing. */
export const STEP_X = 44;
export const STEP_Y = 74;

/** Subtrees move together until their outlines touch, after Reingold and Tilford 1981. */
export function layout(g: Grove, folded: ReadonlySet<number>, order: Order): Layout {
  const at = new Int32Array(g.nodes.length).fill(-1);
  const placed: Placed[] = [];
  const below: number[][] = [];
  const open = g.nodes.flatMap((node, id) => (node.parent === null ? [id] : [])).reverse();
  const roots = [...open].reverse();
  while (open.length > 0) {
    const id = open.pop()!;
    at[id] = placed.length;
    placed.push({ id, x: 0, y: g.levels[id]! * STEP_Y });
    const children = folded.has(id) ? [] : sorted(g, id, order);
    below.push(children);
    for (let i = children.length - 1; i >= 0; i--) open.push(children[i]!);
  }
  // From the leaves up: where each child stands relative to its parent, and the outline of each subtree.
  const shift = new Float64Array(placed.length);
  const outlines: (Outline | null)[] = placed.map(() => null);
  for (let i = placed.length - 1; i >= 0; i--) {
    const parts = below[i]!.map((child) => at[child]!);
    const { outline, offsets } = join(parts.map((part) => outlines[part]!));
    parts.forEach((part, k) => {
      shift[part] = offsets[k]!;
      outlines[part] = null;
    });
    outlines[i] = { left: [0, ...outline.left], right: [0, ...outline.right] };
  }
  const forest = join(roots.map((root) => outlines[at[root]!]!));
  roots.forEach((root, k) => (shift[at[root]!] = forest.offsets[k]!));
  for (let i = 0; i < placed.length; i++) {
    const parent = g.nodes[placed[i]!.id]!.parent;
    placed[i]!.x = shift[i]! + (parent === null ? 0 : placed[at[parent]!]!.x);
  }
  const [least, most] = placed.reduce(([a, b], { x }) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
  placed.forEach((place) => (place.x -= least));
  const height = placed.reduce((h, { y }) => Math.max(h, y), 0);
  return { placed, at, width: Math.max(0, most - least), height };
}

/** The outermost places of a subtree on each level, relative to its top. */
interface Outline { left: number[]; right: number[] }

/** Puts subtrees side by side; offsets are relative to the middle of the first and the last. */
function join(parts: Outline[]): { outline: Outline; offsets: number[] } {
  const offsets: number[] = [];
  const right: number[] = [];
  const left: number[] = [];
  for (const part of parts) {
    let offset = 0;
    for (let level = 0; level < Math.min(right.length, part.left.length); level++) {
      offset = Math.max(offset, right[level]! - part.left[level]! + STEP_X);
    }
    offsets.push(offset);
    part.right.forEach((x, level) => (right[level] = x + offset));
    part.left.forEach((x, level) => (left[level] ??= x + offset));
  }
  const middle = offsets.length > 0 ? (offsets[0]! + offsets[offsets.length - 1]!) / 2 : 0;
  const moved = (xs: number[]): number[] => xs.map((x) => x - middle);
  return { outline: { left: moved(left), right: moved(right) }, offsets: offsets.map((x) => x - middle) };
}
