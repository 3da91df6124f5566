// The formulas against closed forms and recorded numbers.
import { describe, expect, it } from "vitest";

import { changes, compare } from "../../src/data/compare";
import { checks, cramer, determinant } from "../../src/data/cramer";
import { facts } from "../../src/data/facts";
import { grove } from "../../src/data/forest";
import { formulas } from "../../src/data/formula";
import { convergence, histogram } from "../../src/data/histogram";
import { num, percent } from "../../src/data/number";
import { fresnel, mirrored, snell } from "../../src/data/optics";
import { unitTest } from "../../src/data/snippet";
import type { Rgb, Vec3 } from "../../src/data/types";
import { along, distance, plus, scaled, sub, unit } from "../../src/data/vector";
import { numbers, tree } from "../support/synthetic";
import { whitted } from "../support/fixture";

describe("Cramer's rule", () => {
  it("finds a point that was put into the triangle", () => {
    const random = numbers(7);
    const point = (): Vec3 => [random() * 4 - 2, random() * 4 - 2, random() * 4 - 2];
    for (let i = 0; i < 200; i++) {
      const [a, b, c, origin] = [point(), point(), point(), point()];
      const [beta, gamma] = [random() * 0.5, random() * 0.5];
      const target = plus(a, plus(scaled(sub(b, a), beta), scaled(sub(c, a), gamma)));
      const direction = unit(sub(target, origin));
      const { values, detA } = cramer([a, b, c], origin, direction);
      if (Math.abs(detA) < 1e-3) continue;
      expect(values.beta).toBeCloseTo(beta, 9);
      expect(values.gamma).toBeCloseTo(gamma, 9);
      expect(distance(along(origin, direction, values.t), target)).toBeLessThan(1e-9);
    }
  });

  it("has determinants as everybody computes them", () => {
    expect(determinant([[2, 0, 0], [0, 3, 0], [0, 0, 4]])).toBe(24);
    expect(determinant([[1, 2, 3], [4, 5, 6], [7, 8, 9]])).toBe(0);
  });

  it("agrees with what is recorded, and says so if it does not", () => {
    const node = tree(50).nodes.find((n) => n.triangle)!;
    const solved = cramer(node.triangle!, node.origin, node.direction);
    expect(checks(node, solved).map((check) => check.agrees)).toEqual([true, true, true, true]);
    expect(checks({ ...node, t: node.t! + 0.1 }, solved)[0]!.agrees).toBe(false);
  });
});

describe("light at a surface", () => {
  it("is bent, mirrored and split as by hand", () => {
    const n: Vec3 = [0, 1, 0];
    const at = (degrees: number): Vec3 => [Math.sin((degrees * Math.PI) / 180), -Math.cos((degrees * Math.PI) / 180), 0];
    expect(snell(at(48.5), n, 1.333, 1).cosT).not.toBeNull();
    expect(snell(at(48.7), n, 1.333, 1).cosT).toBeNull();
    expect(fresnel(snell(at(0), n, 1, 1.5)).reflect).toBeCloseTo(0.04, 12);
    expect(fresnel(snell(at(56.309932474), n, 1, 1.5)).p).toBeCloseTo(0, 9);
    expect(mirrored(unit([1, -1, 0]), n)).toEqual(unit([1, 1, 0]));
  });
});

describe("substituted formulas", () => {
  it("agree with the record on every ray of whitted", () => {
    const g = grove(whitted().trees[0]!);
    const all = g.nodes.flatMap((node) => formulas(g, node));
    const wrong = all.filter((formula) => formula.check && !formula.check.agrees);
    expect(wrong.map((formula) => `${formula.title}: ${formula.check!.text}`)).toEqual([]);
    expect(all.length).toBeGreaterThan(g.nodes.length);
  });

  it("name Snell and Fresnel where bodies meet, and agree", () => {
    const g = grove(tree(60));
    const titles = formulas(g, g.nodes[0]!).map((formula) => formula.title);
    for (const title of ["What the ray brings", "Snell’s law", "Refraction", "Fresnel", "Mirror reflection"]) expect(titles).toContain(title);
    const wrong = g.nodes.flatMap((node) => formulas(g, node)).filter((formula) => formula.check && !formula.check.agrees);
    expect(wrong).toEqual([]);
  });

  it("disagree when the record is wrong", () => {
    const g = grove(tree(60));
    g.nodes[0]!.result = [9, 9, 9];
    expect(formulas(g, g.nodes[0]!)[0]!.check!.agrees).toBe(false);
  });
});

describe("facts", () => {
  it("show every recorded number with all its digits", () => {
    const node = whitted().trees[0]!.nodes[0]!;
    const all = facts(node).flatMap((group) => group.facts);
    expect(all.find((fact) => fact.name === "t")!.text).toBe("3.3911686");
    expect(all.find((fact) => fact.name === "result")!.text).toBe("0.4903648  0.087230265  0.061882548");
    const shown = new Set(all.map((fact) => fact.name));
    for (const key of ["object", "point", "normal", "cos", "weight", "throughput", "boxes tested"]) expect(shown).toContain(key);
  });
});

describe("comparison", () => {
  const document = whitted();
  const [a, b] = [grove(document.trees[0]!), grove(document.other!.trees[0]!)];

  it("follows what the program found", () => {
    const diff = document.trees[0]!.diff!;
    const pairs = compare(a, b, diff);
    expect(pairs.filter((pair) => pair.fate === "removed").map((pair) => pair.a).sort((x, y) => x - y)).toEqual(diff.removed);
    expect(pairs.filter((pair) => pair.fate === "changed")).toHaveLength(diff.changed!.length);
  });

  it("finds by itself what a depth limit takes away", () => {
    const pairs = compare(a, b);
    expect(new Set(pairs.map((pair) => pair.fate))).toEqual(new Set(["same", "changed", "removed"]));
    expect(pairs.filter((pair) => pair.a >= 0)).toHaveLength(a.nodes.length);
    expect(pairs.filter((pair) => pair.b >= 0)).toHaveLength(b.nodes.length);
    const list = changes(pairs, a, b);
    expect(Math.abs(list[0]!.change)).toBeGreaterThanOrEqual(Math.abs(list[list.length - 1]!.change));
  });

  it("finds nothing between a tree and itself", () => {
    expect(compare(a, a).every((pair) => pair.fate === "same")).toBe(true);
  });
});

describe("samples", () => {
  it("far out are flagged, others are not", () => {
    const values = Array.from({ length: 32 }, (_, i): Rgb => [0.5 + 0.001 * i, 0.5, 0.5]);
    expect(histogram(values, 10).outliers.size).toBe(0);
    values[5] = [40, 40, 40];
    values[6] = [Number.NaN, 0, 0];
    expect([...histogram(values, 10).outliers]).toEqual([5, 6]);
  });

  it("have a mean and an error as by hand", () => {
    const curve = convergence([[1, 1, 1], [3, 3, 3]]);
    expect(curve[1]!.mean).toBeCloseTo(2, 12);
    expect(curve[1]!.error).toBeCloseTo(1.96 * Math.sqrt(2 / 2), 12);
  });
});

describe("texts", () => {
  it("of numbers are short and have a true minus sign", () => {
    expect([0, -0.25, 1234567, 1e-9, Number.NaN, Infinity].map((x) => num(x))).toEqual(["0", "−0.25", "1.235·10⁶", "10⁻⁹".replace("10", "1·10"), "NaN", "∞"]);
    expect([percent(0.5), percent(0.012), percent(1e-5), percent(-0.25)]).toEqual(["50 %", "1.2 %", "<0.1 %", "−25 %"]);
  });

  it("of unit tests hold the numbers and no way out of their strings", () => {
    const first = whitted().trees[0]!;
    const text = unitTest({ ...first, scene: 'a"; evil() //' }, first.nodes[0]!);
    expect(text).toContain('durer::open("a\\"; evil() //")');
    expect(text).toContain("&[0.4903648, 0.087230265, 0.061882548]");
    expect(text).toContain("record([370, 200], 0)");
  });
});
