// Every recorded fact of a ray, in groups, with all its digits.
import type { Body, Node, Rgb } from "./types";

export interface Fact { name: string; text: string; unit?: string; rgb?: Rgb }
export interface Facts { title: string; open: boolean; facts: Fact[] }

/** All digits, and a true minus sign. */
function exact(x: unknown): string {
  if (typeof x === "number") return String(x).replace("-", "−");
  if (typeof x === "boolean") return x ? "yes" : "no";
  if (typeof x === "string") return x;
  if (Array.isArray(x)) return x.map(exact).join("  ");
  return JSON.stringify(x);
}

class Group {
  readonly facts: Fact[] = [];
  constructor(private readonly used: Set<string>, private readonly node: Node) {}

  /** A fact by its key in the document. */
  key(key: keyof Node, unit?: string): this {
    this.used.add(key);
    return this.value(key.replace(/_/g, " "), this.node[key], unit);
  }
  color(key: keyof Node): this {
    this.used.add(key);
    const found = this.node[key];
    if (Array.isArray(found)) this.facts.push({ name: key.replace(/_/g, " "), text: exact(found), rgb: found as Rgb });
    return this;
  }
  value(name: string, found: unknown, unit?: string): this {
    if (found === null || found === undefined) return this;
    this.facts.push({ name, text: exact(found), ...(unit && { unit }) });
    return this;
  }
}

export function facts(node: Node): Facts[] {
  const used = new Set<string>(["light", "floating", "gathered", "media", "fresnel", "lobes", "drawn", "random", "textures", "limit", "tests", "walk", "triangle", "left_out", "whole_id"]);
  const group = (): Group => new Group(used, node);
  const all: Facts[] = [
    { title: "Radiance", open: true, facts: radiance(group()) },
    { title: "Ray", open: true, facts: group().key("id").value("id in the JSON", node.whole_id).key("parent").key("kind").key("depth").key("origin", "m").key("direction").key("t", "m").key("time", "s").facts },
    { title: "Hit", open: true, facts: hit(group(), node) },
    { title: "Light", open: true, facts: light(group(), node) },
    { title: "Medium", open: true, facts: floating(group(), node) },
    { title: "Bodies and Fresnel", open: true, facts: optics(group(), node) },
    { title: "Material", open: false, facts: material(group(), node) },
    { title: "How it was drawn", open: false, facts: drawn(group(), node) },
    { title: "Work", open: false, facts: work(group(), node) },
  ];
  const rest = group();
  for (const key of Object.keys(node)) if (!used.has(key)) rest.key(key as keyof Node);
  all.push({ title: "More", open: false, facts: rest.facts });
  return all.filter((facts) => facts.facts.length > 0);
}

function radiance(g: Group): Fact[] {
  for (const key of ["weight", "throughput", "local", "emission", "ambient", "blurred_sky", "arrived", "result", "contribution", "lost"] as const) g.color(key);
  return g.key("stop").facts;
}

function hit(g: Group, node: Node): Fact[] {
  g.key("object").key("material").key("instance").key("primitive").key("point", "m").key("normal").key("geometric_normal");
  g.key("cos").key("side").key("uv").key("barycentric");
  node.triangle?.forEach((corner, index) => g.value(`corner ${"abc"[index]}`, corner, "m"));
  return g.facts;
}

function light(g: Group, node: Node): Fact[] {
  const l = node.light;
  if (l) {
    g.value("name", l.name).value("index", l.index).value("point on it", l.point, "m").value("visible", l.visible);
    g.facts.push({ name: "unoccluded", text: exact(l.unoccluded), rgb: l.unoccluded });
    if (l.passed) g.facts.push({ name: "passed", text: exact(l.passed), rgb: l.passed });
  }
  if (node.gathered) {
    const { photons, radius, radiance } = node.gathered;
    g.value("photons", photons).value("gathered within", radius, "m");
    g.facts.push({ name: "of photons", text: exact(radiance), rgb: radiance });
  }
  return g.key("blocker").facts;
}

function floating(g: Group, node: Node): Fact[] {
  const f = node.floating;
  if (!f) return g.facts;
  g.value("name", f.medium).value("passed with probability", f.passed);
  g.facts.push({ name: "weight", text: exact(f.weight), rgb: f.weight }, { name: "sent", text: exact(f.sent), rgb: f.sent });
  const s = f.scattered;
  if (s) {
    g.value("particle at", s.point, "m").value("scattering", s.sigma_s, "1/m").value("absorption", s.sigma_a, "1/m");
    g.value("phase function", s.phase).value("mean cosine", s.g);
  }
  return g.facts;
}

function optics(g: Group, node: Node): Fact[] {
  const bodies = (list: Body[] | null | undefined): string =>
    !list?.length ? "none" : list.map((body) => `${body.object} (n ${exact(body.ior)}${typeof body.priority === "number" ? `, priority ${body.priority}` : ""})`).join(", ");
  if (node.media) {
    g.value("n₁", node.media.n1).value("n₂", node.media.n2);
    g.value("in before", bodies(node.media.before)).value("in after", bodies(node.media.after));
  }
  if (node.fresnel) {
    g.value("reflects", node.fresnel.reflect).value("transmits", node.fresnel.transmit);
    g.value("critical angle", node.fresnel.critical_angle, "°").value("total reflection", node.fresnel.tir);
  }
  return g.facts;
}

function material(g: Group, node: Node): Fact[] {
  for (const lobe of node.lobes ?? []) {
    const parts = [
      lobe.reflectance && `reflects ${exact(lobe.reflectance)}`,
      lobe.transmittance && `transmits ${exact(lobe.transmittance)}`,
      typeof lobe.exponent === "number" && `exponent ${exact(lobe.exponent)}`,
      typeof lobe.alpha === "number" && `alpha ${exact(lobe.alpha)}`,
    ];
    const color = lobe.reflectance ?? lobe.transmittance;
    g.facts.push({ name: lobe.name, text: parts.filter(Boolean).join(", "), ...(color && { rgb: color }) });
  }
  for (const texture of node.textures ?? []) {
    const where = `at ${exact(texture.uv)}`;
    const level = typeof texture.level === "number" ? `, level ${exact(texture.level)}` : "";
    const footprint = typeof texture.footprint === "number" ? `, footprint ${exact(texture.footprint)}` : "";
    g.facts.push({
      name: `texture ${texture.name}`, text: `${exact(texture.value)} ${where}${level}${footprint}`,
      ...(texture.value.length === 3 && { rgb: texture.value as Rgb }),
    });
  }
  return g.facts;
}

function drawn(g: Group, node: Node): Fact[] {
  if (node.drawn) {
    g.value("from", node.drawn.from).value("lobe", node.drawn.lobe).value("rays that share", node.drawn.rays).value("chance of this light", node.drawn.chance === 1 ? null : node.drawn.chance).value("chance to live", node.drawn.kept === 1 ? null : node.drawn.kept).value("pdf", node.drawn.pdf, "1/sr").value("pdf of the other way", node.drawn.other_pdf, "1/sr");
    g.value("mis weight", node.drawn.mis).value("f", node.drawn.f, "1/sr").value("cos", node.drawn.cos);
  }
  for (const numbers of node.random ?? []) g.value(`random: ${numbers.dim}`, numbers.u);
  if (node.limit) g.value("value", node.limit.value).value("threshold", node.limit.threshold);
  return g.key("sampler").facts;
}

function work(g: Group, node: Node): Fact[] {
  for (const [name, number] of Object.entries(node.tests ?? {})) g.value(`${name} tested`, number);
  return g.key("ns", "ns").facts;
}
