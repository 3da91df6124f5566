// Marks at a hit: normals, tangent, arcs with degrees, and the legs of Snell's triangle. In units of the circle around
// the hit, so that they keep their size on the screen.
import { Vector3 } from "three";

import type { Grove } from "../data/forest";
import { asksLight, colorOf, type Palette } from "../data/kinds";
import { num, subscript } from "../data/number";
import { facing } from "../data/optics";
import type { Node } from "../data/types";
import type { Line } from "./fatlines";
import type { Space } from "./space";

export interface Label { text: string; at: Vector3; tone: "plain" | "strong" | "quiet" }

export interface Marks { at: Vector3; lines: Line[]; labels: Label[] }

/** The hit that marks belong to: the ray's own, or for a shadow ray the one that it starts from. */
export function hitOf(g: Grove, node: Node): Node | null {
  if (asksLight(node) || !node.point) return node.parent === null ? null : (g.nodes[node.parent] ?? null);
  return node;
}

export function marks(g: Grove, selected: Node, space: Space, palette: Palette, dark: boolean): Marks | null {
  const node = hitOf(g, selected);
  const at = node && facing(node);
  if (!node?.point || !at) return null;
  const [n, v] = [space.direction(at.n), space.direction(at.v)];
  const ink: [number, number, number] = dark ? [0.93, 0.93, 0.9] : [0.12, 0.11, 0.1];
  const out: Marks = { at: space.place(node.point), lines: [], labels: [] };
  const line = (a: Vector3, b: Vector3, color: Line["color"], width: number, dash = 0, arrow = false): void => {
    out.lines.push({ a, b, color, width, dash, order: 0, alpha: 1, arrow });
  };
  const zero = new Vector3();
  line(zero, n.clone().multiplyScalar(1.3), ink, 2, 0, true);
  line(zero, n.clone().multiplyScalar(-1.1), ink, 1, 1);
  out.labels.push({ text: `N${subscript(g.hits[node.id] ?? 0)}`, at: n.clone().multiplyScalar(1.45), tone: "strong" });
  if (node.geometric_normal) {
    const flat = space.direction(node.geometric_normal);
    if (flat.dot(n) < 0) flat.negate();
    if (flat.dot(n) < 0.9995) {
      line(zero, flat.clone().multiplyScalar(1.2), ink, 1.2, 2);
      out.labels.push({ text: "flat normal", at: flat.clone().multiplyScalar(1.3), tone: "quiet" });
    }
  }
  const tangent = v.clone().addScaledVector(n, -v.dot(n));
  if (tangent.lengthSq() < 1e-8) return out;
  tangent.normalize();
  line(tangent.clone().multiplyScalar(-1.25), tangent.clone().multiplyScalar(1.25), ink, 1, 1);
  arc(out, n, v.clone().negate(), colorOf(node.kind, palette), "θ", 0.62);
  for (const id of g.children[node.id] ?? []) {
    const child = g.nodes[id]!;
    const chosen = selected.id === id;
    const sharp = child.kind === "reflection" || child.kind === "refraction";
    if ((!sharp && !chosen) || child.stop === "tir-no-refraction") continue;
    const d = space.direction(child.direction);
    const below = d.dot(n) < 0;
    arc(out, below ? n.clone().negate() : n, d, colorOf(child.kind, palette), asksLight(child) ? "θL" : below ? "θ₂" : "θ′", below ? 0.62 : 0.74);
    if (child.kind === "refraction") triangle(out, node, n, v, d, colorOf(node.kind, palette), colorOf(child.kind, palette));
  }
  return out;
}

/** An arc from an axis to a direction, with its angle. */
function arc(out: Marks, axis: Vector3, d: Vector3, color: Line["color"], name: string, radius: number): void {
  const angle = axis.angleTo(d);
  if (angle < 0.01) return;
  const side = d.clone().addScaledVector(axis, -d.dot(axis)).normalize();
  const on = (a: number): Vector3 => axis.clone().multiplyScalar(Math.cos(a) * radius).addScaledVector(side, Math.sin(a) * radius);
  const parts = Math.max(4, Math.ceil(angle / 0.1));
  for (let i = 0; i < parts; i++) {
    out.lines.push({ a: on((angle * i) / parts), b: on((angle * (i + 1)) / parts), color, width: 2, dash: 0, order: 0, alpha: 1 });
  }
  const text = `${name} ${num((angle * 180) / Math.PI, 3)}°`;
  out.labels.push({ text, at: on(angle / 2).multiplyScalar(1.35), tone: "plain" });
}

/** Opposite legs of the angles on the unit circle: their lengths are as n₂ to n₁. */
function triangle(out: Marks, node: Node, n: Vector3, v: Vector3, t: Vector3, color: Line["color"], childColor: Line["color"]): void {
  if (!node.media || node.media.n1 === node.media.n2) return;
  const from = v.clone().negate();
  const legs: [Vector3, Line["color"], string][] = [[from, color, "sin θ₁"], [t.clone(), childColor, "sin θ₂"]];
  for (const [end, ink, name] of legs) {
    const foot = n.clone().multiplyScalar(end.dot(n));
    out.lines.push({ a: foot, b: end, color: ink, width: 2.2, dash: 0, order: 0, alpha: 1 });
    const length = end.distanceTo(foot);
    out.labels.push({ text: `${name} = ${num(length, 3)}`, at: end.clone().lerp(foot, 0.35).multiplyScalar(1.12), tone: "quiet" });
  }
}
