// Rays as lines: where each starts and ends in the view, how wide it is, when the playback shows it.
import { Vector3 } from "three";

import { luminance } from "../data/color";
import type { Grove } from "../data/forest";
import { asksLight, colorOf, isUntraced, lookOf, type Palette } from "../data/kinds";
import type { Script } from "../data/playback";
import type { Node } from "../data/types";
import type { Line } from "./fatlines";
import type { Ghosts } from "./ghosts";
import type { Space } from "./space";
import { touch } from "./touch";

/** A line of a ray; a ray can have two: a shadow ray is dark beyond what blocks it. */
export interface RayLine extends Line {
  node: number;
  part: "whole" | "lit" | "dark" | "stub";
}

/** Ends of rays in the view. */
export interface Ends {
  a: Vector3;
  b: Vector3;
  /** Leaves the scene, or goes to a light infinitely far away. */
  open: boolean;
  /** Where it is blocked. */
  block: Vector3 | null;
  stub: boolean;
}

export function ends(node: Node, space: Space, ghosts: Ghosts): Ends | null {
  const a = space.place(node.origin);
  const d = space.direction(node.direction);
  const still = { open: false, block: null, stub: false };
  if (isUntraced(node) && node.t === null) {
    if (node.stop === "tir-no-refraction") return null;
    return { a, b: a.clone().addScaledVector(d, space.bounds.radius * 0.05), ...still, stub: true };
  }
  if (asksLight(node)) return toLight(node, a, d, space, ghosts);
  if (node.point) return { a, b: space.place(node.point), ...still };
  return { a, b: a.clone().addScaledVector(d, far(a, d, space)), ...still, open: true };
}

function toLight(node: Node, a: Vector3, d: Vector3, space: Space, ghosts: Ghosts): Ends {
  const light = node.light?.point ? space.place(node.light.point) : null;
  const b = light ?? a.clone().addScaledVector(d, far(a, d, space));
  const base = { a, b, open: !light, stub: false };
  if (node.light?.visible !== false) return { ...base, block: null };
  const reach = a.distanceTo(b);
  const t = node.t !== null ? space.length(node.t) : (node.blocker ? touch(ghosts, node.blocker, a.clone().addScaledVector(d, reach * 1e-4), d, reach) : null);
  const block = a.clone().addScaledVector(d, Math.min(t ?? reach * 0.5, reach));
  return { ...base, block };
}

/** How far it is to a little beyond the ball around the scene. */
function far(a: Vector3, d: Vector3, space: Space): number {
  const { center, radius } = space.bounds;
  const r = radius * 1.15;
  const off = a.clone().sub(center);
  const b = off.dot(d);
  const root = b * b - (off.lengthSq() - r * r);
  const t = root > 0 ? -b + Math.sqrt(root) : 0;
  return t > radius * 0.1 ? t : radius * 0.3;
}

/** Pixels: a ray that is the whole pixel is 4 wide, one that adds nothing 1. */
export function widthOf(node: Node): number {
  const part = Math.min(Math.max(luminance(node.throughput), 0), 1);
  return 1.1 + 2.9 * Math.sqrt(part);
}

const DARK: [number, number, number] = [0.16, 0.2, 0.16];
const DARK_ON_DARK: [number, number, number] = [0.42, 0.46, 0.42];

export interface Style { palette: Palette; dark: boolean; thin?: number; ink?: (node: Node) => [number, number, number] | null }

export function lines(g: Grove, plot: Script | null, space: Space, ghosts: Ghosts, style: Style): RayLine[] {
  const out: RayLine[] = [];
  for (const node of g.nodes) {
    const e = ends(node, space, ghosts);
    if (!e) continue;
    const color = style.ink?.(node) ?? colorOf(node.kind, style.palette);
    const order = plot ? plot.pushed[node.id]! : 0;
    const width = widthOf(node) * (style.thin ?? 1);
    const base = { node: node.id, color, width, dash: lookOf(node.kind).dash, order, alpha: 1 };
    if (e.stub) out.push({ ...base, part: "stub", a: e.a, b: e.b, dash: 2, width: 1.2 });
    else if (e.block) {
      const shade = style.dark ? DARK_ON_DARK : DARK;
      out.push({ ...base, part: "lit", a: e.a, b: e.block, arrow: true });
      out.push({ ...base, part: "dark", a: e.block, b: e.b, color: shade, width: 1, fades: e.open });
    } else out.push({ ...base, part: "whole", a: e.a, b: e.b, arrow: true, fades: e.open });
  }
  return out;
}
