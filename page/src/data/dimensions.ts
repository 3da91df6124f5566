// The dimensions of the samples: place in the pixel, lens, time, and the first numbers drawn for light and scattering.
import type { Page } from "./types";

export interface Dimension {
  name: string;
  from: number;
  to: number;
  /** Value by sample. */
  values: Map<number, number>;
}

/** Those in which samples differ. */
export function dimensions(page: Page): Dimension[] {
  const found = new Map<string, Map<number, number>>();
  const note = (name: string, sample: number, value: number | undefined | null): void => {
    if (typeof value !== "number" || !Number.isFinite(value)) return;
    if (!found.has(name)) found.set(name, new Map());
    if (!found.get(name)!.has(sample)) found.get(name)!.set(sample, value);
  };
  const [px, py] = page.trees[0]!.pixel;
  page.dims.forEach((dims, sample) => {
    note("pixel x", sample, dims.film && dims.film[0] - px);
    note("pixel y", sample, dims.film && dims.film[1] - py);
    note("lens x", sample, dims.lens?.[0]);
    note("lens y", sample, dims.lens?.[1]);
    note("time", sample, dims.time);
  });
  for (const tree of page.trees) {
    for (const node of tree.nodes) {
      for (const drawn of node.random ?? []) {
        if (["film", "lens", "time"].includes(drawn.dim)) continue;
        drawn.u.forEach((u, i) => note(drawn.u.length > 1 ? `${drawn.dim} ${"uvwxyz"[i] ?? i}` : drawn.dim, tree.sample, u));
      }
    }
  }
  const unit = (name: string): boolean => !/^(lens|time)/.test(name);
  return [...found].map(([name, values]) => {
    const all = [...values.values()];
    const [least, most] = [Math.min(...all), Math.max(...all)];
    return unit(name) ? { name, from: Math.min(0, least), to: Math.max(1, most), values } : { name, from: least, to: most, values };
  }).filter((d) => new Set(d.values.values()).size > 1);
}
