// Colours: linear Rec. 709 light, and what a screen shows of it.
import type { Rgb } from "./types";

/** Luminance of linear Rec. 709. */
export function luminance([r, g, b]: Rgb): number {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Linear light 0..1 as a display value 0..1, IEC 61966-2-1. */
export function encode(linear: number): number {
  const x = Math.min(Math.max(linear, 0), 1);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}

/** What a screen shows of light; brighter than white is white. What is no number is magenta. */
export function css(rgb: Rgb): string {
  if (!rgb.every(Number.isFinite)) return "rgb(255 0 255)";
  const [r, g, b] = rgb.map((x) => Math.round(255 * encode(x)));
  return `rgb(${r} ${g} ${b})`;
}

export function add(a: Rgb, b: Rgb): Rgb {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

export function times(a: Rgb, b: Rgb): Rgb {
  return [a[0] * b[0], a[1] * b[1], a[2] * b[2]];
}

export const BLACK: Rgb = [0, 0, 0];

export function isBlack(c: Rgb): boolean {
  return c.every((x) => x === 0);
}
