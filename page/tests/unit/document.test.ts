// The document: reading it, and what follows from a tree.
import { gzipSync } from "node:zlib";
import { describe, expect, it } from "vitest";

import { firstFolds, grove, pathTo, rows } from "../../src/data/forest";
import { layout, STEP_X } from "../../src/data/layout";
import { load, NothingToShow } from "../../src/data/load";
import { narrate } from "../../src/data/narrate";
import { script, stack } from "../../src/data/playback";
import { statistics } from "../../src/data/statistics";
import { page, tree } from "../support/synthetic";
import { whitted } from "../support/fixture";

const packed = (value: unknown): string => gzipSync(JSON.stringify(value)).toString("base64");

describe("the text in the page", () => {
  it("is base64 of gzip of JSON, with line ends or without", async () => {
    const written = tree(12);
    const document = await load(packed(page([written])).replace(/(.{70})/g, "$1\n"));
    expect(document.trees[0]!.nodes).toEqual(written.nodes);
  });

  it("is told from no document, a damaged one and one of another version", async () => {
    await expect(load(["__DURER", "DATA__"].join("_"))).rejects.toThrow(NothingToShow);
    await expect(load("H4sI")).rejects.toThrow(/cannot be read/);
    await expect(load(packed({ ...page([tree(5)]), version: 2 }))).rejects.toThrow(/version 2/);
    await expect(load(packed({ ...page([tree(5)]), trees: [] }))).rejects.toThrow(/no ray/);
  });

  it("may leave out what does not apply", async () => {
    const bare = { version: 1, scene: "s", nodes: [{ kind: "eye", origin: [0, 0, 0], direction: [0, 0, 1], weight: [1, 1, 1], throughput: [1, 1, 1] }] };
    const document = await load(packed({ version: 1, trees: [bare], scene: { name: "s", camera: {} } }));
    const node = document.trees[0]!.nodes[0]!;
    expect([node.parent, node.point, node.stop, node.id]).toEqual([null, null, null, 0]);
    expect(document.scene.objects).toEqual([]);
  });
});

describe("a tree", () => {
  const g = grove(whitted().trees[0]!);

  it("has the letters of the slide", () => {
    expect(g.letters.slice(0, 5)).toEqual(["E", "L₁", "R₁", "L₂", "T₁"]);
  });

  it("has shares that sum to the whole", () => {
    const whole = g.nodes.reduce((sum, node) => sum + node.contribution[0], 0);
    expect(whole).toBeCloseTo(g.tree.rgb[0], 5);
    expect(g.sizes[0]).toBe(g.nodes.length);
  });

  it("hides what is folded and nothing else", () => {
    expect(rows(g, new Set(), "recorded")).toEqual(g.nodes.map((node) => node.id));
    expect(rows(g, new Set([4]), "recorded")).toHaveLength(g.nodes.length - g.sizes[4]! + 1);
    expect(rows(g, new Set(), "contribution").sort((a, b) => a - b)).toEqual(g.nodes.map((node) => node.id));
  });

  it("of ten thousand rays opens with a few hundred rows", () => {
    const large = grove(tree(10_000));
    const shown = rows(large, firstFolds(large, 400), "recorded");
    expect(shown.length).toBeGreaterThan(200);
    expect(shown.length).toBeLessThanOrEqual(400);
  });

  it("is laid out without two rays in one place", () => {
    const large = grove(tree(2000));
    const places = layout(large, new Set(), "recorded").placed;
    const levels = new Map<number, number[]>();
    places.forEach(({ x, y }) => levels.set(y, [...(levels.get(y) ?? []), x]));
    for (const xs of levels.values()) {
      xs.sort((a, b) => a - b);
      xs.slice(1).forEach((x, i) => expect(x - xs[i]!).toBeGreaterThanOrEqual(STEP_X - 1e-9));
    }
    expect(places).toHaveLength(large.nodes.length);
  });

  it("knows the way to each ray", () => {
    expect(pathTo(g, 5).map((id) => g.letters[id])).toEqual(["E", "T₁", g.letters[5]]);
  });
});

describe("playback", () => {
  for (const march of ["recursion", "breadth"] as const) {
    it(`sends and returns each ray once in ${march} order, children within their parent`, () => {
      const g = grove(tree(300));
      const { steps, pushed, popped } = script(g, march);
      expect(steps.filter((step) => step.act === "push")).toHaveLength(g.nodes.length);
      expect(steps.filter((step) => step.act === "pop")).toHaveLength(g.nodes.length);
      for (const node of g.nodes) {
        if (node.parent === null) continue;
        expect(pushed[node.id]!).toBeGreaterThan(pushed[node.parent]!);
        expect(popped[node.id]!).toBeLessThan(popped[node.parent]!);
      }
    });
  }

  it("ends with the value of the sample", () => {
    const g = grove(whitted().trees[0]!);
    const plot = script(g, "recursion");
    const [frame] = stack(g, plot, plot.steps.length - 1);
    frame!.sum.forEach((x, i) => expect(x).toBeCloseTo(g.tree.rgb[i]!, 5));
  });

  it("has a sentence with numbers for every step", () => {
    const g = grove(whitted().trees[0]!);
    const said = script(g, "recursion").steps.map((step) => narrate(g, step));
    expect(said[0]).toBe("The eye ray leaves the eye through pixel (370, 200) and hits “glass ball, outer” after 3.391 m.");
    expect(said.every((sentence) => sentence.endsWith(".") && !sentence.includes("undefined"))).toBe(true);
  });
});

describe("statistics", () => {
  it("count what a hand counts", () => {
    const [first] = whitted().trees;
    const s = statistics([first!]);
    expect(s.kinds.find((kind) => kind.kind === "eye")!.rays).toBe(1);
    expect(s.stops.reduce((sum, stop) => sum + stop.rays, 0)).toBe(first!.nodes.filter((node) => node.stop).length);
    expect(s.depths.reduce((sum, depth) => sum + depth.light, 0)).toBeCloseTo(s.value, 5);
    expect(s.occluded).toBe(first!.nodes.filter((node) => node.stop === "light-occluded").length);
    expect(s.bound).toBeCloseTo(0.008801289 * 2.6, 5);
  });
});
