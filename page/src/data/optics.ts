// Directions and shares at a surface, as the lecture writes them, in double precision.
import { dot, plus, scaled, sub, unit } from "./vector";
import type { Node, Vec3 } from "./types";

/** Unit direction of travel at a hit and the shading normal on the side it comes from. */
export function facing(node: Node): { v: Vec3; n: Vec3 } | null {
  if (!node.normal || !node.point) return null;
  const v = unit(node.direction);
  const n = unit(node.normal);
  return { v, n: dot(v, n) > 0 ? scaled(n, -1) : n };
}

/** R = V - 2 (V.N) N. */
export function mirrored(v: Vec3, n: Vec3): Vec3 {
  return sub(v, scaled(n, 2 * dot(v, n)));
}

export interface Snell {
  n1: number;
  n2: number;
  eta: number;
  cosI: number;
  sinI: number;
  sinT: number;
  /** Null if all is reflected. */
  cosT: number | null;
  t: Vec3 | null;
}

/** T = [eta (N.I) - sqrt(1 - eta^2 (1 - (N.I)^2))] N - eta I, with I = -V. */
export function snell(v: Vec3, n: Vec3, n1: number, n2: number): Snell {
  const eta = n1 / n2;
  const i = scaled(v, -1);
  const cosI = Math.min(Math.max(dot(n, i), 0), 1);
  const sinI = Math.sqrt(1 - cosI * cosI);
  const root = 1 - eta * eta * (1 - cosI * cosI);
  if (root < 0) return { n1, n2, eta, cosI, sinI, sinT: eta * sinI, cosT: null, t: null };
  const cosT = Math.sqrt(root);
  const t = plus(scaled(n, eta * cosI - cosT), scaled(i, -eta));
  return { n1, n2, eta, cosI, sinI, sinT: eta * sinI, cosT, t };
}

export interface Fresnel { s: number; p: number; reflect: number }

/** Unpolarised reflectance between two insulators. */
export function fresnel({ n1, n2, cosI, cosT }: Snell): Fresnel {
  if (cosT === null) return { s: 1, p: 1, reflect: 1 };
  const s = (n1 * cosI - n2 * cosT) / (n1 * cosI + n2 * cosT);
  const p = (n2 * cosI - n1 * cosT) / (n2 * cosI + n1 * cosT);
  return { s, p, reflect: (s * s + p * p) / 2 };
}

/** Angle between unit vectors, radians. */
export function angleBetween(a: Vec3, b: Vec3): number {
  return Math.acos(Math.min(Math.max(dot(unit(a), unit(b)), -1), 1));
}
