// The same document in a world of another size.
import type { Page, Vec3 } from "../../src/data/types";

const KEYS = new Set(["origin", "point", "triangle", "box", "t", "bounds", "eye", "center", "radius", "scale"]);

/** All lengths times a factor; directions, angles and colours stay. */
export function scaledPage(page: Page, factor: number): Page {
  const times = (x: unknown): unknown => (typeof x === "number" ? x * factor : Array.isArray(x) ? x.map(times) : x);
  const walk = (x: unknown): unknown => {
    if (Array.isArray(x)) return x.map(walk);
    if (x === null || typeof x !== "object") return x;
    return Object.fromEntries(Object.entries(x).map(([key, value]) => {
      if (key === "copies") return [key, (value as number[][] | null)?.map((rows) => rows.map((v, i) => (i % 4 === 3 ? v * factor : v)))];
      return [key, KEYS.has(key) ? times(value) : walk(value)];
    }));
  };
  return walk(page) as Page;
}

/** A page of an eye ray alone that meets nothing; the scene stays. */
export function missed(page: Page, direction: Vec3): Page {
  const [tree] = page.trees;
  const [eye] = tree!.nodes;
  const node = { ...eye!, direction, t: null, point: null, object: null, normal: null, stop: "missed-scene", geometric_normal: null };
  return { ...page, other: null, trees: [{ ...tree!, nodes: [node], diff: null }], values: [tree!.rgb], dims: page.dims.slice(0, 1) };
}
