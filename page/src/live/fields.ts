// What stands in the fields of the forms: values as text and back, colours as the browser picks them, steps of sliders.
import { encode } from "../data/color";
import { num } from "../data/number";
import type { Rgb } from "../data/types";
import type { Param, Value } from "./protocol";

/** The value that counts: what was given, else the default. */
export function counts(param: Param): Value | null {
  return param.value ?? param.default;
}

/** Display value 0..1 as linear light. */
export function decode(x: number): number {
  return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
}

/** `#rrggbb` of light; brighter than white is scaled down, so that the hue stays. */
export function hexOf(rgb: Rgb): string {
  const most = Math.max(1, ...rgb.map((x) => (Number.isFinite(x) ? x : 0)));
  return `#${rgb.map((x) => Math.round(255 * encode(Number.isFinite(x) ? x / most : 0)).toString(16).padStart(2, "0")).join("")}`;
}

/** Light of `#rrggbb`, as bright as `like` where that is brighter than white. */
export function rgbOf(hex: string, like: Rgb): Rgb {
  const most = Math.max(1, ...like.map((x) => (Number.isFinite(x) ? x : 0)));
  return [1, 3, 5].map((at) => Number((decode(parseInt(hex.slice(at, at + 2), 16) / 255) * most).toPrecision(6))) as Rgb;
}

export function isTriple(value: Value | null): value is [number, number, number] {
  return Array.isArray(value) && value.length === 3 && value.every((x) => typeof x === "number");
}

/** A number from a field; null if it is none, or out of the closed range. */
export function numberOf(text: string, param: Pick<Param, "min" | "max">, whole: boolean): number | null {
  const value = Number(text.trim().replace(",", ".").replace("−", "-"));
  if (text.trim() === "" || !Number.isFinite(value) || (whole && !Number.isInteger(value))) return null;
  if ((param.min !== null && value < param.min) || (param.max !== null && value > param.max)) return null;
  return value;
}

/** The part of a range that a slider is good for; null if it is endless or too wide for one. */
export function sliderOf(param: Param): { min: number; max: number; step: number } | null {
  const { min, max } = param;
  if (min === null || max === null || !(max > min) || max - min > 1000) return null;
  return { min, max, step: param.type === "int" ? 1 : (max - min) / 200 };
}

/** How far an arrow key moves a number. */
export function stepOf(param: Param, at: number): number {
  if (param.type === "int") return 1;
  const size = Math.abs(at) || Math.abs(Number(param.default)) || 1;
  return 10 ** (Math.floor(Math.log10(size)) - 1);
}

/** As text, for what is shown and not changed. */
export function told(value: Value | null): string {
  if (value === null) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value === "number") return num(value);
  if (typeof value === "string") return value;
  if (Array.isArray(value)) {
    const shown = value.slice(0, 12).map((x) => (typeof x === "number" ? num(x) : x)).join("  ");
    return value.length > 12 ? `${shown} … (${value.length})` : shown;
  }
  if ("texture" in value) return `texture ${value.texture}`;
  if ("blackbody" in value) return `black body of ${num(value.blackbody)} K`;
  return typeof value.spectrum === "string" ? `spectrum ${value.spectrum}` : `spectrum of ${value.spectrum.length / 2} values`;
}

/** Numbers as people type them: no more digits than 32-bit floats have. */
export function typed(x: number): string {
  return String(Number(x.toPrecision(7)));
}
