// A sentence for each step of the recursion, for those who listen.
import { isBlack, times } from "./color";
import type { Grove } from "./forest";
import { asksLight, lookOf, stopOf } from "./kinds";
import { num, percent, share, subscript, triple } from "./number";
import type { Step } from "./playback";
import type { Node } from "./types";

const article = (word: string): string => (/^[aeiou]/.test(word) ? `an ${word}` : `a ${word}`);
const quoted = (name: string | null | undefined): string => (name ? `“${name}”` : "something without a name");

/** The angle between a ray and the normal where it ends, in degrees. */
export function incidence(node: Node): number | null {
  const cos = cosine(node);
  return cos === null ? null : (Math.acos(Math.min(cos, 1)) * 180) / Math.PI;
}

/** Cosine of ray and shading normal, never negative. */
export function cosine(node: Node): number | null {
  if (typeof node.cos === "number") return node.cos;
  if (!node.normal) return null;
  const [a, b] = [node.normal, node.direction];
  return Math.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

export function narrate(g: Grove, step: Step): string {
  const node = g.nodes[step.node]!;
  switch (step.act) {
    case "push": return sent(g, node);
    case "shade": return shaded(g, node);
    case "pop": return returned(g, node);
  }
}

function sent(g: Grove, node: Node): string {
  const name = g.letters[node.id] ?? "";
  if (node.kind === "eye") {
    const [x, y] = g.tree.pixel;
    return `The eye ray leaves the eye through pixel (${x}, ${y})${met(node)}`;
  }
  if (asksLight(node)) return asked(name, node);
  const stop = node.stop ? stopOf(node.stop) : null;
  const word = lookOf(node.kind).word;
  if (node.t === null && stop && node.stop !== "missed-scene") {
    return `No ${word} ${name} is traced. ${stop.says}${limits(node)}`;
  }
  return `${capital(article(word))}, ${name}, starts with the weight ${triple(node.weight, 3)}${met(node)}${bent(g, node)}`;
}

function met(node: Node): string {
  if (node.point) {
    const side = node.side === "inside" ? " from inside" : "";
    return ` and hits ${quoted(node.object)}${side} after ${num(node.t)} m.`;
  }
  return " and leaves the scene.";
}

/** What refraction did to the angle. */
function bent(g: Grove, node: Node): string {
  const parent = node.parent === null ? null : g.nodes[node.parent];
  if (node.kind !== "refraction" || !parent?.media) return "";
  const { n1, n2 } = parent.media;
  const angle = incidence(parent);
  if (angle === null || n1 === n2) return "";
  const sin = (n1 / n2) * Math.sin((angle * Math.PI) / 180);
  const bentTo = (Math.asin(Math.min(sin, 1)) * 180) / Math.PI;
  return ` Going from n = ${num(n1)} to n = ${num(n2)} bends it from ${num(angle, 3)}° to ${num(bentTo, 3)}°.`;
}

function limits(node: Node): string {
  if (!node.limit) return isBlack(node.lost) ? "" : ` It would have carried ${triple(node.lost, 3)} of the pixel.`;
  const { value, threshold } = node.limit;
  return ` (${num(value)} against ${num(threshold)}.) It would have carried ${triple(node.lost, 3)} of the pixel.`;
}

function asked(name: string, node: Node): string {
  const light = quoted(node.light?.name ?? `light ${node.light?.index ?? "?"}`);
  const ask = `Is ${light} to be seen? The shadow ray ${name} `;
  if (node.light && !node.light.visible) {
    return `${ask}is stopped by ${quoted(node.blocker)}: ${triple(node.light.unoccluded, 3)} does not arrive.`;
  }
  if (node.stop === "light-behind-surface") return `${ask}need not be traced: the light is behind the surface.`;
  return `${ask}reaches it: ${triple(node.result, 3)} arrives.`;
}

function shaded(g: Grove, node: Node): string {
  const below = g.children[node.id]!.length;
  const follow = below === 0 ? "nothing follows" : below === 1 ? "one ray follows" : `${below} rays follow`;
  const stop = node.stop && below === 0 ? ` ${stopOf(node.stop).says}` : "";
  const place = `At ${hitName(g, node.id)}`;
  if (isBlack(node.local)) return `${place} the surface itself adds no light; ${follow}.${stop}`;
  return `${place} the ambient term and emission add ${triple(node.local, 3)}; ${follow}.${stop}`;
}

function returned(g: Grove, node: Node): string {
  const name = g.letters[node.id] ?? "";
  if (node.parent === null) return `The eye ray returns ${triple(node.result, 3)}: the value of this sample.`;
  const parent = hitName(g, node.parent);
  const added = times(node.weight, node.result);
  if (isBlack(added)) return `${name} brings ${parent} nothing.`;
  const part = share(times(node.throughput, node.result), g.tree.rgb);
  return `${name} returns ${triple(node.result, 3)}; times its weight it adds ${triple(added, 3)} to ${parent}: ${percent(part)} of the sample.`;
}

/** N with the hit's number, as on the slide. */
function hitName(g: Grove, id: number): string {
  return g.hits[id] ? `N${subscript(g.hits[id]!)}` : "the surface";
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
