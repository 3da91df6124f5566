// The formulas of a ray with its numbers substituted, term by term.
import { add, BLACK, isBlack, times } from "./color";
import type { Grove } from "./forest";
import { asksLight } from "./kinds";
import { degrees, num, subscript, triple, tuple } from "./number";
import { angleBetween, facing, fresnel, mirrored, snell } from "./optics";
import { distance } from "./vector";
import type { Node, Rgb, Vec3 } from "./types";

/** A piece of a line: a symbol, a number, plain text; a colour to show; a ray to go to. */
export interface Term { text: string; as: "symbol" | "number" | "text"; rgb?: Rgb; node?: number }

export interface Formula {
  title: string;
  lines: Term[][];
  /** A recorded number beside the one computed here. */
  check?: { agrees: boolean; text: string };
}

const sym = (text: string): Term => ({ text, as: "symbol" });
const val = (text: string): Term => ({ text, as: "number" });
const say = (text: string): Term => ({ text, as: "text" });
const rgb = (color: Rgb): Term => ({ text: tuple(color), as: "number", rgb: color });
const ray = (g: Grove, id: number): Term => ({ text: g.letters[id] ?? String(id), as: "symbol", node: id });
const nearRgb = (a: Rgb, b: Rgb): boolean => a.every((x, i) => Math.abs(x - b[i]!) <= 1e-5 * (1 + Math.abs(x)));

export function formulas(g: Grove, node: Node): Formula[] {
  const maybe = [
    sum(g, node), lightArrives(node), local(node), weight(g, node), share(g, node), place(node), angle(node),
    mirror(g, node), bending(node), refracted(g, node), reflectance(node), highlight(g, node), limit(node),
  ];
  return maybe.filter((f): f is Formula => f !== null);
}

/** L = local + sum of weight x result. */
function sum(g: Grove, node: Node): Formula | null {
  const below = g.children[node.id] ?? [];
  const missing = node.left_out;
  if (below.length === 0 && !missing) return null;
  const most = 24;
  const shown = below.length > most ? below.slice(0, most) : below;
  const total = below.reduce((s, id) => add(s, times(g.nodes[id]!.weight, g.nodes[id]!.result)), missing ? add(node.local, missing.result) : node.local);
  const lines: Term[][] = [
    [sym("L"), say(" = "), sym("local"), say(" + Σ "), sym("weight × L"), say(" of the rays below")],
    [say("= "), rgb(node.local), say("  "), sym("local")],
    ...shown.map((id): Term[] => {
      const child = g.nodes[id]!;
      return [say("+ "), rgb(child.weight), say(" × "), rgb(child.result), say("  "), ray(g, id)];
    }),
  ];
  if (shown.length < below.length) lines.push([say(`+ ${below.length - shown.length} more`)]);
  if (missing) lines.push([say("+ "), rgb(missing.result), say(`  of ${missing.rays} rays left out of this page`)]);
  lines.push([say("= "), rgb(total)]);
  const agrees = nearRgb(total, node.result);
  return { title: "What the ray brings", lines, check: { agrees, text: `recorded ${tuple(node.result)}` } };
}

function lightArrives(node: Node): Formula | null {
  if (!asksLight(node) || !node.light) return null;
  const { unoccluded, visible } = node.light;
  const passed = node.light.passed ?? (visible ? [1, 1, 1] : [0, 0, 0]);
  const arrives = times(unoccluded, passed as Rgb);
  const lines = [
    [sym("L"), say(" = "), sym("light"), say(" × "), sym("passed")],
    [say("= "), rgb(unoccluded), say(" × "), rgb(passed as Rgb)],
    [say("= "), rgb(arrives)],
  ];
  return { title: "Light that arrives", lines, check: { agrees: nearRgb(arrives, node.result), text: `recorded ${tuple(node.result)}` } };
}

function local(node: Node): Formula | null {
  const named: [string, Rgb | null | undefined][] = [["emission", node.emission], ["ambient", node.ambient], ["sky, blurred", node.blurred_sky], ["photons", node.gathered?.radiance]];
  const parts = named.filter((part): part is [string, Rgb] => !!part[1] && !isBlack(part[1]));
  if (parts.length === 0) return null;
  const total = parts.reduce((s, [, part]) => add(s, part), BLACK);
  const joined = (terms: Term[]): Term[] => terms.flatMap((term, i) => (i ? [say(" + "), term] : [term]));
  return {
    title: "Light of its own",
    lines: [
      [sym("local"), say(" = "), ...joined(parts.map(([name]) => sym(name)))],
      [say("= "), ...joined(parts.map(([, part]) => rgb(part)))],
      [say("= "), rgb(total)],
    ],
    check: { agrees: nearRgb(total, node.local), text: `recorded ${tuple(node.local)}` },
  };
}

/** How the weight came about: f cos / pdf, times the share of this way of sampling. */
function weight(g: Grove, node: Node): Formula | null {
  const d = node.drawn;
  if (node.parent === null || !d) return null;
  const names: Term[] = [];
  const values: Term[] = [];
  if (d.f) {
    names.push(sym("f"));
    values.push(rgb(d.f));
  }
  if (typeof d.cos === "number") {
    names.push(sym("cos θ"));
    values.push(val(num(d.cos)));
  }
  if (names.length === 0) return null;
  const joined = (terms: Term[]): Term[] => terms.flatMap((term, i) => (i ? [say(" × "), term] : [term]));
  const [up, down] = [joined(names), joined(values)];
  if (typeof d.pdf === "number" && d.from !== "light") {
    up.push(say(" / "), sym("pdf"));
    down.push(say(" / "), val(num(d.pdf)));
  }
  if (typeof d.mis === "number") {
    up.push(say(" × "), sym("mis"));
    down.push(say(" × "), val(num(d.mis)));
  }
  const rays = d.rays ?? 1;
  if (rays > 1) {
    up.push(say(" / "), sym("rays"));
    down.push(say(" / "), val(num(rays)));
  }
  const chance = d.chance ?? 1;
  if (chance < 1) {
    up.push(say(" / "), sym("chance"));
    down.push(say(" / "), val(num(chance)));
  }
  const kept = d.kept ?? 1;
  if (kept < 1) {
    up.push(say(" / "), sym("kept"));
    down.push(say(" / "), val(num(kept)));
  }
  const factor = ((d.cos ?? 1) * (d.mis ?? 1)) / ((d.from === "light" ? 1 : (d.pdf ?? 1)) * rays * chance * kept);
  const product = d.f ? (d.f.map((x) => x * factor) as Rgb) : null;
  const agrees = product !== null && nearRgb(product, node.weight);
  // What else went into it, as the share of light that is left on the way, is not repeated here.
  const lines = [[sym("weight"), say(agrees ? " = " : " ∝ "), ...up], [say(agrees ? "= " : "∝ "), ...down], [say("= "), rgb(node.weight)]];
  return { title: `Weight of ${g.letters[node.id]}, drawn from ${d.lobe ?? d.from}`, lines };
}

function share(g: Grove, node: Node): Formula | null {
  const parent = node.parent === null ? null : g.nodes[node.parent];
  const lines: Term[][] = [];
  if (parent) {
    lines.push(
      [sym("throughput"), say(" = "), sym("throughput"), say(" of "), ray(g, parent.id), say(" × "), sym("weight")],
      [say("= "), rgb(parent.throughput), say(" × "), rgb(node.weight)],
      [say("= "), rgb(node.throughput)],
    );
  }
  lines.push(
    [sym("contribution"), say(" = "), sym("throughput"), say(" × "), sym("local")],
    [say("= "), rgb(node.throughput), say(" × "), rgb(node.local)],
    [say("= "), rgb(times(node.throughput, node.local))],
  );
  const agrees = nearRgb(times(node.throughput, node.local), node.contribution);
  return { title: "Share in the pixel", lines, check: { agrees, text: `recorded ${tuple(node.contribution)}` } };
}

function place(node: Node): Formula | null {
  if (!node.point || node.t === null) return null;
  const at = node.origin.map((o, i) => o + node.t! * node.direction[i]!) as Vec3;
  const off = distance(at, node.point);
  return {
    title: "Where it ends",
    lines: [
      [sym("P"), say(" = "), sym("O + t D")],
      [say("= "), val(tuple(node.origin)), say(" + "), val(num(node.t)), say(" × "), val(tuple(node.direction))],
      [say("= "), val(tuple(at))],
    ],
    check: { agrees: off <= 1e-3 * (Math.abs(node.t) + Math.max(...node.point.map(Math.abs))), text: `recorded ${tuple(node.point)}` },
  };
}

function angle(node: Node): Formula | null {
  const at = facing(node);
  if (!at) return null;
  const cos = -(at.v[0] * at.n[0] + at.v[1] * at.n[1] + at.v[2] * at.n[2]);
  const recorded = node.cos;
  return {
    title: "Angle of incidence",
    lines: [
      [sym("cos θ"), say(" = "), sym("−V · N")],
      [say("= −"), val(tuple(at.v)), say(" · "), val(tuple(at.n))],
      [say("= "), val(num(cos)), say("   "), sym("θ"), say(" = "), val(degrees(Math.acos(Math.min(cos, 1))))],
    ],
    ...(typeof recorded === "number" && { check: { agrees: Math.abs(recorded - cos) < 1e-4, text: `recorded ${num(recorded)}` } }),
  };
}

const childOf = (g: Grove, node: Node, kind: string): Node | undefined =>
  (g.children[node.id] ?? []).map((id) => g.nodes[id]!).find((child) => child.kind === kind && child.stop !== "tir-no-refraction");

function mirror(g: Grove, node: Node): Formula | null {
  const [at, child] = [facing(node), childOf(g, node, "reflection")];
  if (!at || !child) return null;
  const r = mirrored(at.v, at.n);
  const vn = at.v[0] * at.n[0] + at.v[1] * at.n[1] + at.v[2] * at.n[2];
  const off = angleBetween(r, child.direction);
  return {
    title: "Mirror reflection",
    lines: [
      [sym("R"), say(" = "), sym("V − 2 (V · N) N")],
      [say("= "), val(tuple(at.v)), say(" − 2 × "), val(num(vn)), say(" × "), val(tuple(at.n))],
      [say("= "), val(tuple(r)), say("  "), ray(g, child.id)],
    ],
    check: { agrees: off < 1e-3, text: `recorded ${tuple(child.direction)}` },
  };
}

function bending(node: Node): Formula | null {
  const at = facing(node);
  if (!at || !node.media || node.media.n1 === node.media.n2) return null;
  const s = snell(at.v, at.n, node.media.n1, node.media.n2);
  const lines: Term[][] = [
    [sym("n₁ sin θ₁ = n₂ sin θ₂")],
    [val(num(s.n1)), say(" × "), val(num(s.sinI)), say(" = "), val(num(s.n2)), say(" × "), val(num(s.sinT))],
    [sym("θ₁"), say(" = "), val(degrees(Math.asin(Math.min(s.sinI, 1)))), say("   "), sym("θ₂"), say(" = "),
      s.cosT === null ? say("none: sin θ₂ > 1, all is reflected") : val(degrees(Math.asin(Math.min(s.sinT, 1))))],
  ];
  const critical = node.fresnel?.critical_angle;
  if (typeof critical === "number") lines.push([say("critical angle "), val(`${num(critical)}°`)]);
  const recorded = node.fresnel?.tir;
  return {
    title: "Snell’s law",
    lines,
    ...(typeof recorded === "boolean" && {
      check: { agrees: recorded === (s.cosT === null), text: recorded ? "recorded: total reflection" : "recorded: refracted" },
    }),
  };
}

function refracted(g: Grove, node: Node): Formula | null {
  const [at, child] = [facing(node), childOf(g, node, "refraction")];
  if (!at || !child || !node.media) return null;
  const s = snell(at.v, at.n, node.media.n1, node.media.n2);
  if (!s.t || s.cosT === null) return null;
  const off = angleBetween(s.t, child.direction);
  return {
    title: "Refraction",
    lines: [
      [sym("T"), say(" = "), sym("[η (N · I) − √(1 − η² (1 − (N · I)²))] N − η I")],
      [sym("η"), say(" = "), sym("n₁ / n₂"), say(" = "), val(num(s.eta)), say(",  "), sym("N · I"), say(" = "), val(num(s.cosI)),
        say(",  √ = "), val(num(s.cosT))],
      [say("= "), val(num(s.eta * s.cosI - s.cosT)), say(" "), val(tuple(at.n)), say(" − "), val(num(s.eta)), say(" "),
        val(tuple(at.v.map((x) => -x)))],
      [say("= "), val(tuple(s.t)), say("  "), ray(g, child.id)],
    ],
    check: { agrees: off < 2e-3, text: `recorded ${tuple(child.direction)}` },
  };
}

function reflectance(node: Node): Formula | null {
  const at = facing(node);
  if (!at || !node.media || !node.fresnel || node.fresnel.constant) return null;
  const s = snell(at.v, at.n, node.media.n1, node.media.n2);
  const f = fresnel(s);
  const agrees = Math.abs(f.reflect - node.fresnel.reflect) < 1e-3;
  if (s.cosT === null) {
    return { title: "Fresnel", lines: [[sym("R"), say(" = "), val("1"), say(": total reflection")]],
      check: { agrees, text: `recorded R ${num(node.fresnel.reflect)}` } };
  }
  const [ni, nt] = [num(s.n1), num(s.n2)];
  const [ci, ct] = [num(s.cosI), num(s.cosT)];
  return {
    title: "Fresnel",
    lines: [
      [sym("r⊥ = (n₁ cos θ₁ − n₂ cos θ₂) / (n₁ cos θ₁ + n₂ cos θ₂)")],
      [say("= "), val(`(${ni} × ${ci} − ${nt} × ${ct}) / (${ni} × ${ci} + ${nt} × ${ct})`), say(" = "), val(num(f.s))],
      [sym("r∥ = (n₂ cos θ₁ − n₁ cos θ₂) / (n₂ cos θ₁ + n₁ cos θ₂)")],
      [say("= "), val(`(${nt} × ${ci} − ${ni} × ${ct}) / (${nt} × ${ci} + ${ni} × ${ct})`), say(" = "), val(num(f.p))],
      [sym("R"), say(" = "), sym("½ (r⊥² + r∥²)"), say(" = "), val(num(f.reflect)), say(",  "), sym("T"), say(" = "), val(num(1 - f.reflect))],
    ],
    check: { agrees, text: `recorded R ${num(node.fresnel.reflect)}` },
  };
}

/** Phong's cosine of a shadow ray at the hit it starts from. */
function highlight(g: Grove, node: Node): Formula | null {
  const parent = node.parent === null ? null : g.nodes[node.parent];
  if (!asksLight(node) || !parent) return null;
  const at = facing(parent);
  const shiny = parent.lobes?.find((lobe) => typeof lobe.exponent === "number");
  const exponent = shiny?.exponent;
  if (!at || typeof exponent !== "number") return null;
  const r = mirrored(at.v, at.n);
  const cos = Math.max(0, Math.cos(angleBetween(r, node.direction)));
  const half = [0, 1, 2].map((i) => node.direction[i]! - at.v[i]!) as Vec3;
  const cosHalf = Math.max(0, Math.cos(angleBetween(half, at.n)));
  return {
    title: `Highlight at N${subscript(g.hits[parent.id] ?? 0)}`,
    lines: [
      [sym("R · L"), say(" = "), val(num(cos)), say(",  "), sym("(R · L)ⁿ"), say(" with "), sym("n"), say(" = "), val(num(exponent)),
        say(" is "), val(num(cos ** exponent))],
      [sym("N · H"), say(" = "), val(num(cosHalf)), say(",  "), sym("(N · H)ⁿ"), say(" is "), val(num(cosHalf ** exponent))],
      ...(shiny?.reflectance ? [[say(`${shiny.name} `), rgb(shiny.reflectance)]] : []),
    ],
  };
}

function limit(node: Node): Formula | null {
  if (!node.limit) return null;
  const small = node.stop === "contribution-below-cutoff";
  const { value, threshold } = node.limit;
  return {
    title: small ? "Too small" : "Too deep",
    lines: [
      [sym(small ? "share" : "depth"), say(" = "), val(num(value)), say(small ? " ≤ " : " > "), val(num(threshold))],
      [say("it would have carried "), val(triple(node.lost)), say(" of the pixel")],
    ],
  };
}
