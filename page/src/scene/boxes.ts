// The boxes that a ray's walk through the hierarchy tested, as wires.
import { Vector3 } from "three";

import type { WalkedBox } from "../data/types";
import type { Line } from "./fatlines";
import type { Space } from "./space";

/** Hit and missed boxes. */
export const HIT: [number, number, number] = [0.93, 0.6, 0.1];
export const MISS: [number, number, number] = [0.55, 0.58, 0.64];

/** Corners are numbered by bits: x, y, z. */
const EDGES = [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]] as const;

/** Wires of the boxes up to `last`; the last is wide. */
export function wires(walk: WalkedBox[], last: number, space: Space): Line[] {
  return walk.slice(0, last + 1).flatMap(({ box, hit }, index) => {
    const corner = (bits: number): Vector3 =>
      space.place([box[bits & 1]![0], box[(bits >> 1) & 1]![1], box[(bits >> 2) & 1]![2]]);
    const now = index === last;
    return EDGES.map(([a, b]) => ({
      a: corner(a), b: corner(b), color: hit ? HIT : MISS, width: now ? 3 : 1.2, dash: hit ? 0 : 1, order: 0,
      alpha: now ? 1 : hit ? 0.55 : 0.3,
    }));
  });
}
