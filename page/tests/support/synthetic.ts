// A page of any size without the program: rays that split at glass triangles, every fact filled in and consistent.
import { add, BLACK, times } from "../../src/data/color";
import { fresnel, mirrored, snell } from "../../src/data/optics";
import { along, cross, plus, scaled, unit } from "../../src/data/vector";
import type { Node, Page, Rgb, Tree, Vec3 } from "../../src/data/types";

/** Numbers 0..1 that are the same in every run. */
export function numbers(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

const grey = (x: number): Rgb => [x, x, x];

/** A tree of about `size` rays: each hit has a shadow ray, a reflected and a refracted ray. */
export function tree(size: number, sample = 0, seed = 1): Tree {
  const random = numbers(seed);
  const nodes: Node[] = [];
  const open: { parent: number | null; kind: Node["kind"]; origin: Vec3; direction: Vec3; weight: number; n1: number }[] = [
    { parent: null, kind: "eye", origin: [0, 1, -6], direction: unit([0.02, -0.1, 1]), weight: 1, n1: 1 },
  ];
  for (let next = open.shift(); next; next = open.shift()) {
    const { parent, kind, origin, direction, weight, n1 } = next;
    const id = nodes.length;
    const above = parent === null ? null : nodes[parent]!;
    const shadow = kind === "shadow";
    const full = nodes.length + open.length >= size;
    const t = 0.4 + 2 * random();
    const point = along(origin, direction, t);
    const tilt = unit([random() - 0.5, random() - 0.5, random() - 0.5]);
    const normal = unit(plus(scaled(direction, -1), scaled(tilt, 0.6)));
    const hit = !shadow && !full;
    const n2 = n1 === 1 ? 1.5 : 1;
    const s = snell(direction, normal, n1, n2);
    const f = fresnel(s);
    const [u, v] = [unit(cross(normal, tilt)), cross(normal, unit(cross(normal, tilt)))];
    const corner = (x: number, y: number): Vec3 => plus(point, plus(scaled(u, x), scaled(v, y)));
    const local: Rgb = shadow ? [random() * 2, random() * 2, random() * 1.5] : hit ? grey(0.01) : [0.2, 0.4, 0.7];
    const throughput = grey(above ? above.throughput[0] * weight : 1);
    nodes.push({
      id, parent, kind, depth: above ? above.depth + 1 : 0, origin, direction, t: hit || shadow ? t : null, point: hit ? point : null,
      object: hit ? `facet ${id}` : null, primitive: hit ? 0 : null, normal: hit ? normal : null, uv: hit ? [random(), random()] : null,
      side: hit ? (n1 === 1 ? "outside" : "inside") : null, weight: grey(weight), throughput, local,
      contribution: times(throughput, local), result: BLACK, stop: shadow ? "hit-light" : hit ? null : "missed-scene", lost: BLACK,
      light: shadow ? { index: 0, name: "lamp", point, visible: true, passed: [1, 1, 1], unoccluded: local } : null, blocker: null,
      tests: { boxes: 3, primitives: 1 }, random: [{ dim: "light", u: [random(), random()] }],
      ...(hit && {
        cos: s.cosI, geometric_normal: normal, barycentric: [1 / 3, 1 / 3, 1 / 3] as Vec3,
        triangle: [corner(1, 0), corner(-0.5, 0.8), corner(-0.5, -0.8)] as [Vec3, Vec3, Vec3],
        media: { n1, n2 }, fresnel: { reflect: f.reflect, transmit: 1 - f.reflect, tir: s.cosT === null },
        ...(id < 40 && { walk: [0, 1, 2].map((depth) => ({ box: [corner(-2, -2), corner(2, 2)] as [Vec3, Vec3], depth, hit: depth !== 1 })) }),
      }),
    });
    if (!hit) continue;
    open.push({ parent: id, kind: "shadow", origin: point, direction: unit([0.3, 0.9, -0.2]), weight: 0.1, n1 });
    open.push({ parent: id, kind: "reflection", origin: point, direction: mirrored(direction, normal), weight: f.reflect, n1 });
    if (s.t) open.push({ parent: id, kind: "refraction", origin: point, direction: s.t, weight: 1 - f.reflect, n1: n2 });
  }
  nodes.forEach((node) => (node.result = node.local));
  for (const node of [...nodes].reverse()) {
    if (node.parent === null) continue;
    const above = nodes[node.parent]!;
    above.result = add(above.result, times(node.weight, node.result));
  }
  return {
    version: 1, scene: "facets", integrator: "whitted", width: 64, height: 48, pixel: [31, 23], sample, samples: 4, rgb: nodes[0]!.result,
    film: [31.5, 23.5], rules: { max_depth: 40, min_contribution: 0 }, killed: BLACK, max_radiance: 2, nodes: ordered(nodes),
  };
}

/** Breadth first as made, depth first as recorded. */
function ordered(nodes: Node[]): Node[] {
  const below = new Map<number | null, Node[]>();
  nodes.forEach((node) => below.set(node.parent, [...(below.get(node.parent) ?? []), node]));
  const out: Node[] = [];
  const open: [Node, number | null][] = [[nodes[0]!, null]];
  while (open.length > 0) {
    const [node, parent] = open.pop()!;
    const id = out.length;
    out.push({ ...node, id, parent });
    for (const child of (below.get(node.id) ?? []).slice().reverse()) open.push([child, id]);
  }
  return out;
}

/** As the program writes large trees: six digits, and without what can be computed or is seldom asked for. */
export function brief(full: Tree): Tree {
  const rounded = (_: string, x: unknown): unknown => (typeof x === "number" ? Number(x.toPrecision(6)) : x);
  const left = new Set(["walk", "random", "triangle", "barycentric", "uv", "geometric_normal"]);
  const nodes = full.nodes.map((node) => Object.fromEntries(Object.entries(node).filter(([key, x]) => x !== null && !left.has(key))));
  return JSON.parse(JSON.stringify({ ...full, nodes }, rounded)) as Tree;
}

export function page(trees: Tree[]): Page {
  return {
    version: 1, trees, other: null, values: trees.map((t) => t.rgb), dims: trees.map(() => ({ film: [31.5, 23.5] })), mean: trees[0]!.rgb,
    picture: null,
    scene: {
      name: "facets", bounds: [[-5, -5, -7], [5, 5, 5]], objects: [], lights: [],
      camera: { eye: [0, 1, -6], right: [1, 0, 0], up: [0, 1, 0], look: [0, 0, 1], fov_x: 50, fov_y: 38, kind: "perspective" },
    },
  };
}
