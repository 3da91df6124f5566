// Numbers as text: few digits, a true minus sign, thin spaces in large ones.
import { luminance } from "./color";
import type { Rgb, Vec3 } from "./types";

/** `digits` significant digits, without trailing zeros. */
export function num(x: number | null | undefined, digits = 4): string {
  if (x === null || x === undefined) return "–";
  if (Number.isNaN(x)) return "NaN";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "−∞";
  if (x === 0) return "0";
  const size = Math.abs(x);
  let text: string;
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa = "", exponent = ""] = x.toExponential(digits - 1).split("e");
    const short = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
    text = `${short}·10${superscript(Number(exponent))}`;
  } else {
    text = String(Number(x.toPrecision(digits)));
  }
  return text.replace("-", "−");
}

function superscript(n: number): string {
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  const text = [...String(Math.abs(n))].map((d) => digits[Number(d)]).join("");
  return n < 0 ? `⁻${text}` : text;
}

/** Counts: 12 345. */
export function count(n: number): string {
  return String(Math.round(n)).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

export function triple(v: Vec3 | Rgb | number[] | null | undefined, digits = 4): string {
  return v ? v.map((x) => num(x, digits)).join("  ") : "–";
}

export function tuple(v: number[] | null | undefined, digits = 4): string {
  return v ? `(${v.map((x) => num(x, digits)).join(", ")})` : "–";
}

export function degrees(radians: number): string {
  return `${num((radians * 180) / Math.PI, 3)}°`;
}

export function percent(share: number): string {
  if (!Number.isFinite(share)) return "–";
  const p = share * 100;
  const size = Math.abs(p);
  const text = size === 0 ? "0" : size < 0.1 ? "<0.1" : size < 10 ? size.toFixed(1) : size.toFixed(0);
  return `${p < 0 && size >= 0.05 ? "−" : ""}${text} %`;
}

/** How much of the whole, by luminance. */
export function share(part: Rgb, whole: Rgb): number {
  const all = luminance(whole);
  return all > 0 ? luminance(part) / all : 0;
}

const SUB = "₀₁₂₃₄₅₆₇₈₉";

/** Subscript digits. */
export function subscript(n: number): string {
  return [...String(n)].map((d) => SUB[Number(d)] ?? d).join("");
}
