// What the 3D view is of, and how large that is. Worlds have any size, the numbers of graphics cards have not: all that is
// drawn is moved and scaled so that this ball has its centre at 0 and radius 1.
import { bytesOf } from "../data/load";
import type { Page, SceneObject, Vec3 } from "../data/types";
import { distance, dot, length, cross, sub } from "../data/vector";

export interface Ball { center: Vec3; radius: number }

/** A floor that reaches to the horizon must not make all else a dot: most that is shown, by the size of what rays touch. */
const WIDEST = 6;

const isPlace = (p: Vec3 | null | undefined): p is Vec3 => Array.isArray(p) && p.length === 3 && p.every(Number.isFinite);

/** The ball around the box of some places; null if they are one place, up to rounding. */
export function around(places: Vec3[]): Ball | null {
  const [low, high]: [Vec3, Vec3] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (const p of places) {
    for (const i of [0, 1, 2] as const) {
      low[i] = Math.min(low[i], p[i]);
      high[i] = Math.max(high[i], p[i]);
    }
  }
  if (places.length === 0) return null;
  const center: Vec3 = [0, 1, 2].map((i) => low[i]! / 2 + high[i]! / 2) as Vec3;
  const radius = places.reduce((r, p) => Math.max(r, distance(p, center)), 0);
  return radius > 1e-12 * length(center) && radius < Infinity ? { center, radius } : null;
}

/** The ball around all that is worth seeing, in the world's numbers. */
export function whole(page: Page): Ball {
  const touched = places(page);
  const bounds = (page.scene.bounds ?? []).filter(isPlace);
  const scene = bounds.length === 2 && distance(bounds[0]!, bounds[1]!) > 0 ? bounds : [];
  const all = around([...touched, ...scene]);
  const near = around(touched);
  if (near) return all && all.radius <= WIDEST * near.radius ? all : { center: near.center, radius: WIDEST * near.radius };
  // Nothing was hit: the eye alone says where things are, and things how large all is.
  const eye = touched[0] ?? [0, 0, 0];
  const reach = outlook(page, eye);
  if (reach === null) return all ?? { center: eye, radius: 1 };
  return all && all.radius <= 4 * reach ? all : { center: eye, radius: 2 * reach };
}

/** Where rays start and what they hit: the eye first. */
function places(page: Page): Vec3[] {
  const nodes = page.trees[0]?.nodes ?? [];
  const ends = nodes.flatMap((node) => [node.origin, node.point]);
  return [page.scene.camera.eye, ...ends].filter(isPlace);
}

/** How far it is from a place to the far side of things: of half of them it is less. Of endless things it is twice the
 * distance. Null if there is nothing. */
function outlook(page: Page, from: Vec3): number | null {
  const [things, planes]: [number[], number[]] = [[], []];
  for (const object of page.scene.objects) {
    if (object.plane) {
      const off = fromPlane(object, from);
      if (off !== null && off > 0) planes.push(2 * off);
    } else things.push(...balls(object).map((ball) => distance(from, ball.center) + ball.radius));
  }
  const lights = page.scene.lights.map((light) => light.point).filter(isPlace).map((p) => distance(from, p));
  const found = [things, planes, lights].find((list) => list.some((x) => x > 0));
  if (!found) return null;
  found.sort((a, b) => a - b);
  return found.slice(found.length >> 1).find((x) => x > 0) ?? null;
}

/** Corners of a mesh's box, or places on it if there are few; before its copies are placed. */
export function corners(object: SceneObject): Vec3[] {
  const { mesh } = object;
  if (!mesh) return [];
  const steps = new Uint16Array(bytesOf(mesh.positions).buffer);
  const scale = typeof mesh.scale === "number" ? [mesh.scale, mesh.scale, mesh.scale] : mesh.scale;
  const place = (q: number[]): Vec3 => q.map((x, i) => mesh.origin[i]! + scale[i]! * x) as Vec3;
  const points = Array.from({ length: Math.floor(steps.length / 3) }, (_, i) => [...steps.subarray(3 * i, 3 * i + 3)]);
  if (points.length <= 8) return points.map(place);
  const [low, high] = [Math.min, Math.max].map((pick) => points.reduce((a, b) => a.map((x, i) => pick(x, b[i]!)))) as [number[], number[]];
  return Array.from({ length: 8 }, (_, bits) => place(low.map((x, i) => (bits & (1 << i) ? high[i]! : x))));
}

function balls(object: SceneObject): Ball[] {
  if (object.sphere) return [object.sphere];
  const own = corners(object);
  const copies = object.copies?.length ? object.copies : [null];
  return copies.map((copy) => around(copy ? own.map((p) => moved(copy, p)) : own)).filter((ball) => ball !== null);
}

/** A place of a mesh in the world: rows of a 3 x 4 matrix. */
export function moved(rows: number[], [x, y, z]: Vec3): Vec3 {
  return [0, 4, 8].map((i) => rows[i]! * x + rows[i + 1]! * y + rows[i + 2]! * z + rows[i + 3]!) as Vec3;
}

function fromPlane(object: SceneObject, from: Vec3): number | null {
  const [copy] = object.copies ?? [];
  const [a, b, c] = corners(object).map((p) => (copy ? moved(copy, p) : p));
  if (!a || !b || !c) return null;
  const n = cross(sub(b, a), sub(c, a));
  return length(n) > 0 ? Math.abs(dot(sub(from, a), n)) / length(n) : null;
}

/** What the view opens with, in its own numbers: around the eye and the hits, or all if nothing was hit. */
export function opening(eye: Vec3, hits: Vec3[]): Ball {
  const found = hits.length > 0 ? around([eye, ...hits]) : null;
  return found ? { center: found.center, radius: Math.max(found.radius, 0.12) } : { center: [0, 0, 0], radius: 1.02 };
}

/** From how far away a ball fills a picture of an opening in degrees, upright, and of an aspect. */
export function standoff(radius: number, fov: number, aspect: number): number {
  return (radius * 1.02) / Math.sin(Math.atan(Math.tan((fov * Math.PI) / 360) * Math.min(1, aspect)));
}
