// What the rays of trees add up to: by kind, length, light and lobe; what was cut off.
import { add, BLACK, luminance } from "./color";
import { asksLight, isUntraced, lookOf } from "./kinds";
import type { Kind, Node, Rgb, Tree } from "./types";

export interface Share { name: string; rays: number; light: number; kind?: Kind }

export interface Statistics {
  rays: number;
  kinds: Share[];
  stops: { name: string; rays: number }[];
  /** By depth: rays, and what their own light adds to the pixel. */
  depths: { depth: number; rays: number; light: number }[];
  lights: (Share & { asked: number; occluded: number })[];
  lobes: Share[];
  asked: number;
  occluded: number;
  /** Mean value of the samples, by luminance. */
  value: number;
  killed: Rgb;
  /** Upper bound on what was cut off, by luminance. */
  bound: number;
  /** Why there is no such bound: then `bound` is by the brightest light that was seen. */
  unbounded: string | null;
  boxes: number;
  primitives: number;
}

export function statistics(trees: Tree[]): Statistics {
  const kinds = new Map<Kind, Share>();
  const stops = new Map<string, number>();
  const depths = new Map<number, { depth: number; rays: number; light: number }>();
  const lights = new Map<string, Share & { asked: number; occluded: number }>();
  const lobes = new Map<string, Share>();
  const of = Math.max(trees.length, 1);
  const s: Statistics = {
    rays: 0, kinds: [], stops: [], depths: [], lights: [], lobes: [], asked: 0, occluded: 0,
    value: trees.reduce((sum, tree) => sum + luminance(tree.rgb), 0) / of,
    killed: BLACK, bound: 0, unbounded: null, boxes: 0, primitives: 0,
  };
  for (const tree of trees) {
    for (const node of tree.nodes) {
      const light = luminance(node.contribution) / of;
      const traced = isUntraced(node) ? 0 : 1;
      s.rays += traced;
      s.boxes += node.tests?.boxes ?? 0;
      s.primitives += node.tests?.primitives ?? 0;
      const kind = kinds.get(node.kind) ?? { name: lookOf(node.kind).word, rays: 0, light: 0, kind: node.kind };
      kinds.set(node.kind, { ...kind, rays: kind.rays + traced, light: kind.light + light });
      if (node.stop) stops.set(node.stop, (stops.get(node.stop) ?? 0) + 1);
      const depth = depths.get(node.depth) ?? { depth: node.depth, rays: 0, light: 0 };
      depths.set(node.depth, { ...depth, rays: depth.rays + traced, light: depth.light + light });
      const lobe = lobeOf(node);
      const found = lobes.get(lobe) ?? { name: lobe, rays: 0, light: 0 };
      lobes.set(lobe, { ...found, rays: found.rays + traced, light: found.light + light });
      if (asksLight(node)) countLight(s, lights, node, light);
    }
    s.killed = add(s.killed, killedOf(tree).map((x) => x / of) as Rgb);
    s.bound += missingOf(tree) / of;
    s.unbounded ??= tree.no_bound ?? null;
  }
  const byLight = <T extends { light: number; rays: number }>(list: Iterable<T>) =>
    [...list].sort((a, b) => b.light - a.light || b.rays - a.rays);
  s.kinds = [...kinds.values()];
  s.stops = [...stops].map(([name, rays]) => ({ name, rays })).sort((a, b) => b.rays - a.rays);
  s.depths = [...depths.values()].sort((a, b) => a.depth - b.depth);
  s.lights = byLight(lights.values());
  s.lobes = byLight(lobes.values());
  return s;
}

function countLight(s: Statistics, lights: Map<string, Share & { asked: number; occluded: number }>, node: Node, light: number) {
  const name = node.light?.name ?? `light ${node.light?.index ?? "?"}`;
  const occluded = node.stop === "light-occluded" ? 1 : 0;
  const asked = isUntraced(node) ? 0 : 1;
  s.asked += asked;
  s.occluded += occluded;
  const found = lights.get(name) ?? { name, rays: 0, light: 0, asked: 0, occluded: 0 };
  lights.set(name, {
    name, rays: found.rays + 1, light: found.light + light,
    asked: found.asked + asked, occluded: found.occluded + occluded,
  });
}

/** Where a ray's own light comes from. */
function lobeOf(node: Node): string {
  if (node.drawn?.from && !["light", "sharp"].includes(node.drawn.from)) return node.drawn.from;
  if (asksLight(node)) return "direct light";
  if (node.kind === "eye") return "seen directly";
  return lookOf(node.kind).word;
}

export function killedOf(tree: Tree): Rgb {
  return tree.killed ?? tree.nodes.reduce((sum, node) => add(sum, node.lost), BLACK);
}

/** What is missing of a tree at most, by luminance. */
function missingOf(tree: Tree): number {
  return tree.missing ? luminance(tree.missing) : luminance(killedOf(tree)) * maxRadiance(tree);
}

export function maxRadiance(tree: Tree): number {
  if (typeof tree.max_radiance === "number") return tree.max_radiance;
  return tree.nodes.reduce((most, node) => Math.max(most, ...node.result.filter(Number.isFinite)), 0);
}
