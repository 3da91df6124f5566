// The lecture's intersection of ray and triangle: a 3x3 system by Cramer's rule, in double precision.
import { sub } from "./vector";
import type { Node, Vec3 } from "./types";

/** A matrix by its columns. */
export type Matrix = [Vec3, Vec3, Vec3];

export interface Cramer {
  /** Columns a - b, a - c, R_d. */
  a: Matrix;
  /** A with its first, second and third column replaced by a - R_o. */
  beta: Matrix;
  gamma: Matrix;
  t: Matrix;
  detA: number;
  detBeta: number;
  detGamma: number;
  detT: number;
  values: { alpha: number; beta: number; gamma: number; t: number };
}

export function determinant([a, b, c]: Matrix): number {
  return a[0] * (b[1] * c[2] - c[1] * b[2]) - b[0] * (a[1] * c[2] - c[1] * a[2]) + c[0] * (a[1] * b[2] - b[1] * a[2]);
}

/** Solves a + beta (b - a) + gamma (c - a) = R_o + t R_d. */
export function cramer(triangle: [Vec3, Vec3, Vec3], origin: Vec3, direction: Vec3): Cramer {
  const [a, b, c] = triangle;
  const [ab, ac, ao] = [sub(a, b), sub(a, c), sub(a, origin)];
  const base: Matrix = [ab, ac, direction];
  const beta: Matrix = [ao, ac, direction];
  const gamma: Matrix = [ab, ao, direction];
  const t: Matrix = [ab, ac, ao];
  const [detA, detBeta, detGamma, detT] = [base, beta, gamma, t].map(determinant) as [number, number, number, number];
  const [x, y] = [detBeta / detA, detGamma / detA];
  return {
    a: base, beta, gamma, t, detA, detBeta, detGamma, detT,
    values: { alpha: 1 - x - y, beta: x, gamma: y, t: detT / detA },
  };
}

/** A number computed here beside the recorded one. */
export interface Check { name: string; here: number; recorded: number; agrees: boolean }

/** Recorded numbers are single precision, of a ray whose origin was moved off the surface it started from. */
export function checks(node: Node, solved: Cramer): Check[] {
  const { alpha, beta, gamma, t } = solved.values;
  const size = node.triangle ? Math.max(...node.triangle.flat().map(Math.abs), ...node.origin.map(Math.abs)) : 1;
  const check = (name: string, here: number, recorded: number | null | undefined, allowed: number): Check[] =>
    typeof recorded === "number" ? [{ name, here, recorded, agrees: Math.abs(here - recorded) <= allowed }] : [];
  const [u, v, w] = node.barycentric ?? [null, null, null];
  return [
    ...check("t", t, node.t, 1e-4 * (1 + size)),
    ...check("α", alpha, u, 2e-3),
    ...check("β", beta, v, 2e-3),
    ...check("γ", gamma, w, 2e-3),
  ];
}
