// The kinds of rays: letters and colours of the lecture, dash patterns, words for people.
import type { Kind, Node } from "./types";

export type Palette = "lecture" | "safe";

export interface Look {
  /** Letter on the lecture's slide. */
  letter: string;
  word: string;
  /** 0..1 as a display value. */
  color: [number, number, number];
  /** For those who see red and green alike: after Okabe and Ito 2008. */
  safe: [number, number, number];
  /** Pattern: 0 solid, 1 dashed, 2 dotted, 3 long dashes, 4 dash and dot. */
  dash: number;
}

const GREY: Look["color"] = [0.7, 0.7, 0.7];
const GREEN: Look["color"] = [0.1, 0.9, 0.1];
const RED: Look["color"] = [0.9, 0.1, 0.1];
const BLUE: Look["color"] = [0.1, 0.1, 0.9];
const SAFE_GREY: Look["color"] = [0.6, 0.6, 0.6];
const SAFE_GREEN: Look["color"] = [0.94, 0.894, 0.259];
const SAFE_RED: Look["color"] = [0.835, 0.369, 0];
const SAFE_BLUE: Look["color"] = [0, 0.447, 0.698];

const look = (letter: string, word: string, color: Look["color"], safe: Look["color"], dash: number): Look => ({
  letter, word, color, safe, dash,
});

export const LOOKS: Record<Kind, Look> = {
  eye: look("E", "eye ray", GREY, SAFE_GREY, 0),
  shadow: look("L", "shadow ray", GREEN, SAFE_GREEN, 1),
  reflection: look("R", "reflected ray", RED, SAFE_RED, 0),
  refraction: look("T", "refracted ray", BLUE, SAFE_BLUE, 3),
  "glossy-reflection": look("R", "glossy reflection", RED, SAFE_RED, 2),
  "glossy-refraction": look("T", "glossy refraction", BLUE, SAFE_BLUE, 2),
  passing: look("P", "passing ray", GREY, SAFE_GREY, 4),
  scattered: look("M", "ray from a particle", [0.55, 0.35, 0.85], [0.8, 0.475, 0.655], 4),
  "diffuse-bounce": look("D", "diffuse bounce", [0.9, 0.6, 0.1], [0.902, 0.624, 0], 4),
  environment: look("S", "sky", [0.3, 0.75, 0.9], [0.337, 0.706, 0.914], 1),
  "light-sample": look("L", "light sample", GREEN, SAFE_GREEN, 1),
  "bsdf-sample": look("B", "BSDF sample", [0.8, 0.3, 0.8], [0.8, 0.475, 0.655], 2),
  connection: look("C", "connection", [0.8, 0.7, 0.1], [0.902, 0.624, 0], 4),
  photon: look("F", "photon", [0.9, 0.7, 0.1], [0.902, 0.624, 0], 2),
};

export function lookOf(kind: Kind): Look {
  return LOOKS[kind] ?? LOOKS.passing;
}

export function colorOf(kind: Kind, palette: Palette): [number, number, number] {
  const found = lookOf(kind);
  return palette === "safe" ? found.safe : found.color;
}

export function cssOf(kind: Kind, palette: Palette): string {
  return `rgb(${colorOf(kind, palette).map((x) => Math.round(x * 255)).join(" ")})`;
}

/** True of rays that ask whether a light is seen. */
export function asksLight(node: Node): boolean {
  return node.kind === "shadow" || node.kind === "light-sample" || node.kind === "connection";
}

/** True of rays that were given up before they were traced. */
export function isUntraced(node: Node): boolean {
  return UNTRACED.has(node.stop ?? "");
}

const UNTRACED = new Set(["depth-limit", "contribution-below-cutoff", "tir-no-refraction", "absorbed", "roulette", "cancelled", "light-behind-surface", "below-horizon"]);

/** Reasons to stop: a sign for badges, and what it means. */
export const STOPS: Record<string, { sign: string; word: string; says: string }> = {
  "missed-scene": { sign: "∞", word: "left the scene", says: "It meets nothing and leaves the scene." },
  "hit-light": { sign: "☀", word: "reached the light", says: "Nothing is in the way: the light arrives." },
  absorbed: { sign: "●", word: "absorbed", says: "Nothing of its light would arrive." },
  "depth-limit": { sign: "⊥", word: "depth limit", says: "The recursion is as deep as the rules allow." },
  "contribution-below-cutoff": { sign: "ε", word: "too small", says: "Its share in the pixel is below the cut-off." },
  "light-occluded": { sign: "◐", word: "in shadow", says: "Something is in the way: no light arrives." },
  "light-behind-surface": { sign: "◑", word: "light behind", says: "The light is behind the surface." },
  "below-horizon": { sign: "⌓", word: "below the horizon", says: "The direction lies below the true surface." },
  "tir-no-refraction": { sign: "↩", word: "total reflection", says: "All light is reflected inside: no refracted ray exists." },
  "opaque-no-children": { sign: "■", word: "opaque", says: "The surface neither mirrors nor lets light through." },
  "nan-rejected": { sign: "!", word: "not a number", says: "A value was not a number and was left out." },
  cancelled: { sign: "×", word: "cancelled", says: "The work was stopped." },
  roulette: { sign: "⚂", word: "roulette", says: "Russian roulette ended it." },
  clamped: { sign: "⊤", word: "clamped", says: "A part of its light was cut off." },
};

export function stopOf(stop: string): { sign: string; word: string; says: string } {
  return STOPS[stop] ?? { sign: "?", word: stop, says: `It stopped: ${stop}.` };
}
