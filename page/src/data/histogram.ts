// The values of a pixel's samples: bins, outliers, the running mean and how sure it is.
import { luminance } from "./color";
import type { Rgb } from "./types";

export interface Histogram {
  from: number;
  to: number;
  bins: number[][];
  /** Indices of samples far above the others. */
  outliers: Set<number>;
  mean: number;
  deviation: number;
}

/** Sorts samples into bins by luminance. Outliers lie more than three quartile distances above the third quartile. */
export function histogram(values: Rgb[], count: number): Histogram {
  const lights = values.map(luminance);
  const finite = lights.filter(Number.isFinite).sort((a, b) => a - b);
  const from = finite[0] ?? 0;
  const to = finite[finite.length - 1] ?? 1;
  const bins: number[][] = Array.from({ length: count }, () => []);
  const width = to > from ? (to - from) / count : 1;
  const outliers = new Set<number>();
  const limit = fence(finite);
  lights.forEach((light, index) => {
    if (!Number.isFinite(light)) {
      outliers.add(index);
      return;
    }
    if (light > limit) outliers.add(index);
    bins[Math.min(count - 1, Math.floor((light - from) / width))]!.push(index);
  });
  const mean = finite.reduce((a, b) => a + b, 0) / Math.max(finite.length, 1);
  const squares = finite.reduce((a, b) => a + (b - mean) ** 2, 0);
  return { from, to, bins, outliers, mean, deviation: Math.sqrt(squares / Math.max(finite.length - 1, 1)) };
}

function fence(sorted: number[]): number {
  if (sorted.length < 4) return Infinity;
  const at = (share: number) => sorted[Math.floor(share * (sorted.length - 1))]!;
  const [q1, q3] = [at(0.25), at(0.75)];
  return q3 + Math.max(3 * (q3 - q1), 0.1 * Math.abs(q3) + 1e-6);
}

/** Mean of the first 1, 2, ... samples with the half width of its 95 % interval. */
export function convergence(values: Rgb[]): { mean: number; error: number }[] {
  let [mean, squares, n] = [0, 0, 0];
  return values.map((value) => {
    const light = luminance(value);
    if (Number.isFinite(light)) {
      n += 1;
      const step = light - mean;
      mean += step / n;
      squares += step * (light - mean);
    }
    return { mean, error: n > 1 ? 1.96 * Math.sqrt(squares / (n - 1) / n) : 0 };
  });
}
