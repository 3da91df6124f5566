// The page in Debian's Chromium: opened from disk, the network cut, steered by mouse and keyboard.
import { statSync } from "node:fs";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import type { Browser, Page as Tab } from "playwright-core";

import type { Page, Tree } from "../../src/data/types";
import { launch, open, type Opened } from "../support/browser";
import { whitted } from "../support/fixture";
import { missed, scaledPage } from "../support/scale";
import { write } from "../support/fill";
import { brief, page, tree } from "../support/synthetic";

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

/** What the inspector shows as a recorded fact, with a minus sign that programs read. */
async function fact(tab: Tab, name: string): Promise<string> {
  const text = await tab.locator(`.records [data-fact="${name}"]`).first().textContent();
  return (text ?? "").replace(/−/g, "-").replace(/ m$/, "").trim();
}

const canvas = (tab: Tab, what: string): Promise<string | null> => tab.locator(".view canvas").getAttribute(`data-${what}`);
const shows = async (tab: Tab, id: number): Promise<void> => {
  await tab.waitForSelector(`.inspector[data-node="${id}"]`);
  await expect.poll(() => canvas(tab, "selected")).toBe(String(id));
};

async function done({ tab, requests, complaints }: Opened): Promise<void> {
  expect(requests).toEqual([]);
  expect(complaints).toEqual([]);
  await tab.context().close();
}

describe("the page", () => {
  const document = whitted();
  const first: Tree = document.trees[0]!;
  let path: string;
  beforeAll(() => {
    path = write(document, "whitted");
  });

  it("opens from disk with the network cut, asks for nothing and complains of nothing", async () => {
    const opened = await open(browser, path);
    expect(await opened.tab.title()).toBe("whitted (370, 200) – ray tree");
    expect(await canvas(opened.tab, "seen")).toBe(String(first.nodes.filter((node) => node.stop !== "tir-no-refraction").length));
    const reached = await opened.tab.evaluate(() => fetch("https://example.org/").then(() => true, () => false));
    expect(reached).toBe(false);
    opened.complaints.length = 0;
    await done(opened);
  });

  it("shows the numbers of the JSON for every ray that is clicked", async () => {
    const opened = await open(browser, path, { hash: "#tree=outline" });
    for (const node of first.nodes) {
      await opened.tab.locator(`#row-${node.id} .name`).click();
      await shows(opened.tab, node.id);
      expect(await fact(opened.tab, "result")).toBe(node.result.map(String).join("  "));
      expect(await fact(opened.tab, "throughput")).toBe(node.throughput.map(String).join("  "));
      if (node.t !== null) expect(await fact(opened.tab, "t")).toBe(String(node.t));
      if (node.object !== null) expect(await fact(opened.tab, "object")).toBe(node.object);
    }
    await done(opened);
  });

  it("links the slide, the 3D view and the inspector", async () => {
    const opened = await open(browser, path);
    const { tab } = opened;
    const slide = (await tab.locator("canvas.slide").boundingBox())!;
    // Around the middle of the slide there is a ray under some point; hovering tells the 3D view at once.
    let id = -1;
    search: for (let y = 60; y < slide.height; y += 18) {
      for (let x = 20; x < slide.width; x += 18) {
        await tab.mouse.move(slide.x + x, slide.y + y);
        const hovered = await canvas(tab, "hovered");
        if (hovered && hovered !== "0") {
          id = Number(hovered);
          await tab.mouse.click(slide.x + x, slide.y + y);
          break search;
        }
      }
    }
    expect(id).toBeGreaterThan(0);
    await shows(tab, id);
    // And back: a click on a ray in the 3D view.
    const view = (await tab.locator(".view canvas").boundingBox())!;
    const found = new Set<string>();
    for (let x = 0.2; x < 0.9; x += 0.03) {
      await tab.mouse.click(view.x + view.width * x, view.y + view.height * 0.5);
      found.add((await canvas(tab, "selected"))!);
    }
    expect(found.size).toBeGreaterThan(1);
    await shows(tab, Number(await canvas(tab, "selected")));
    await done(opened);
  });

  it("plays the recursion: stack, sentence and rays go together", async () => {
    const opened = await open(browser, path, { hash: "#view=play" });
    const { tab } = opened;
    await tab.getByRole("button", { name: "Step forward" }).click();
    expect(await canvas(tab, "seen")).toBe("1");
    await expect.poll(() => tab.locator(".playbar .story").textContent()).toContain("The eye ray leaves the eye");
    await tab.getByRole("button", { name: "Step forward" }).click();
    await tab.getByRole("button", { name: "Step forward" }).click();
    expect(await canvas(tab, "seen")).toBe("2");
    expect(await tab.locator(".calls li").count()).toBe(2);
    await tab.getByRole("button", { name: "Step back" }).click();
    expect(await tab.locator(".calls li").count()).toBe(1);
    await tab.getByRole("button", { name: "fast" }).click();
    await tab.getByRole("button", { name: "Play", exact: true }).click();
    await expect.poll(() => tab.locator(".playbar .story").textContent(), { timeout: 30_000 }).toContain("the value of this sample");
    const sum = await tab.locator(".calls li .sum").first().textContent();
    expect(sum).toContain("0.49");
    await done(opened);
  });

  it("shows what another depth limit changes", async () => {
    const opened = await open(browser, path, { hash: "#view=compare" });
    const { tab } = opened;
    await expect.poll(() => tab.locator(".lead").textContent()).toContain("87 %");
    const diff = first.diff!;
    await tab.locator(".fates button", { hasText: "changed" }).click();
    const rows = tab.locator(".changes li");
    await expect.poll(() => rows.count()).toBe(diff.changed!.length);
    const eye = rows.filter({ hasText: "eye ray" });
    expect(await eye.textContent()).toContain("0.4904");
    expect(await eye.textContent()).toContain("0.02868");
    await tab.locator(".fates button", { hasText: "gone" }).click();
    await tab.locator(".changes li[data-fate=removed] button").first().click();
    expect(diff.removed).toContain(Number(await canvas(tab, "selected")));
    await done(opened);
  });

  it("is steered by the keyboard alone", async () => {
    const opened = await open(browser, path);
    const { tab } = opened;
    await tab.keyboard.press("ArrowDown");
    await tab.keyboard.press("ArrowDown");
    await shows(tab, 2);
    await tab.keyboard.press("ArrowLeft");
    await tab.keyboard.press("ArrowLeft");
    await shows(tab, 0);
    await tab.keyboard.press("End");
    await shows(tab, first.nodes.length - 1);
    await tab.keyboard.press(".");
    expect(await canvas(tab, "seen")).toBe("1");
    await tab.keyboard.press("0");
    await tab.keyboard.press("?");
    await tab.waitForSelector("dialog[open]");
    await tab.keyboard.press("Escape");
    await tab.waitForSelector("dialog:not([open])", { state: "attached" });
    await tab.keyboard.press("4");
    await tab.waitForSelector(".body.of-samples");
    await tab.keyboard.press("]");
    await expect.poll(() => tab.locator(".picker select").inputValue()).toBe("1");
    const dark = (): Promise<string | null> => tab.locator("html").getAttribute("data-theme");
    const before = await dark();
    await tab.keyboard.press("d");
    expect(await dark()).not.toBe(before);
    // Tab reaches every control, and what has the focus is outlined.
    const seen = new Set<string>();
    for (let i = 0; i < 60; i++) {
      await tab.keyboard.press("Tab");
      seen.add(await tab.evaluate(() => {
        const it = window.document.activeElement!;
        const outline = getComputedStyle(it).outlineStyle;
        return outline === "none" && it !== window.document.body ? `no outline: ${it.outerHTML.slice(0, 80)}` : it.tagName;
      }));
    }
    expect([...seen].filter((word) => word.startsWith("no outline"))).toEqual([]);
    for (const tag of ["BUTTON", "SELECT", "INPUT", "CANVAS"]) expect(seen).toContain(tag);
    await done(opened);
  });

  it("keeps its state in the address", async () => {
    const opened = await open(browser, path);
    await opened.tab.keyboard.press("End");
    await opened.tab.keyboard.press("5");
    await expect.poll(() => opened.tab.evaluate(() => location.hash)).toContain(`ray=${first.nodes.length - 1}&view=numbers`);
    const hash = await opened.tab.evaluate(() => location.hash);
    await done(opened);
    const again = await open(browser, path, { hash });
    await again.tab.waitForSelector(".body.of-numbers");
    expect(await canvas(again.tab, "selected")).toBe(String(first.nodes.length - 1));
    await done(again);
  });

  it("takes names as text, whatever is in them", async () => {
    const evil = '<img src=x onerror="window.hacked=1"><script>window.hacked=1</script>';
    const bad = structuredClone(document);
    bad.scene.name = evil;
    bad.trees[0]!.nodes[0]!.object = evil;
    bad.trees[0]!.nodes.forEach((node) => node.light && (node.light.name = evil));
    const opened = await open(browser, write(bad, "evil"), { hash: "#view=numbers" });
    await opened.tab.keyboard.press("ArrowDown");
    expect(await opened.tab.evaluate(() => "hacked" in window)).toBe(false);
    expect(await opened.tab.locator("h1").textContent()).toBe(evil);
    await done(opened);
  });

  for (const [width, height] of [[390, 844], [768, 1024], [1280, 800], [1920, 1080]] as const) {
    it(`fits ${width} x ${height} in every view`, async () => {
      const opened = await open(browser, path, { width, height });
      for (const tab of ["tree", "ray", "play", "samples", "numbers", "compare", "walk", "machine"]) {
        await opened.tab.evaluate((view) => (location.hash = `#view=${view}`), tab);
        await opened.tab.waitForTimeout(80);
        const [wide, high] = await opened.tab.evaluate(() => [window.document.documentElement.scrollWidth, window.document.documentElement.scrollHeight]);
        expect([wide, high]).toEqual([width, height]);
        const spills = await opened.tab.locator(".body").evaluate((body) => body.scrollWidth - body.clientWidth);
        expect(spills, tab).toBeLessThanOrEqual(1);
      }
      await done(opened);
    });
  }
});

/** Pixels of the 3D view, read by the page's own graphics: how many have another colour than the corner. */
const marked = (tab: Tab): Promise<number> => tab.evaluate(() => {
  const viewer = window.durer!.viewer!;
  const gl = viewer["renderer"].getContext();
  // Drawn and read in one go: a picture that was shown is no longer there.
  viewer["frame"](performance.now());
  const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const pixels = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let count = 0;
  for (let i = 4; i < pixels.length; i += 4) {
    if (Math.abs(pixels[i]! - pixels[0]!) + Math.abs(pixels[i + 1]! - pixels[1]!) + Math.abs(pixels[i + 2]! - pixels[2]!) > 12) count++;
  }
  return count / (w * h);
});

describe("the 3D view", () => {
  const upwards: [number, number, number] = [0, 1, 0];
  for (const size of [1e-18, 1, 1e18]) {
    it(`shows something of a world of size ${size}, hit or missed`, async () => {
      for (const document of [whitted(), missed(whitted(), upwards)]) {
        const opened = await open(browser, write(scaledPage(document, size), "sized"));
        expect(await marked(opened.tab)).toBeGreaterThan(0.05);
        // And without the ghosts: the rays themselves.
        await opened.tab.evaluate(() => void (window.durer!.viewer!.ghosts.group.visible = false));
        expect(await marked(opened.tab)).toBeGreaterThan(0.0005);
        await done(opened);
      }
    });
  }

  it("is drawn in a few calls, and only if something changes", async () => {
    for (const document of [whitted(), page([brief(tree(10_000))])]) {
      const opened = await open(browser, write(document, "calls"));
      const { tab } = opened;
      await tab.evaluate(() => window.durer!.viewer!.turn(3));
      expect(Number(await canvas(tab, "calls"))).toBeLessThanOrEqual(8);
      await tab.waitForTimeout(2500);
      const frames = await canvas(tab, "frames");
      await tab.waitForTimeout(1000);
      expect(await canvas(tab, "frames")).toBe(frames);
      expect(Number(await canvas(tab, "calls"))).toBeLessThanOrEqual(8);
      await done(opened);
    }
  });
});

describe("a page that had no room for all rays", () => {
  it("says how many, where, and how to get them", async () => {
    const whole = tree(40);
    const missing = { rays: 1234, contribution: [0.01, 0.01, 0.01] as [number, number, number], result: [0, 0, 0] as [number, number, number] };
    const nodes = whole.nodes.map((node) => (node.id === 1 ? { ...node, whole_id: 7, left_out: missing } : { ...node, whole_id: node.id }));
    const cut = { ...page([{ ...whole, nodes, left_out: missing }]), left_out: ["the rays of 5 more samples"] };
    const opened = await open(browser, write(cut, "cut"), { hash: "#tree=outline" });
    const { tab } = opened;
    const note = tab.locator(".column.tree .left-out");
    const [told, all] = ((await note.locator("summary").textContent()) ?? "").match(/[\d\s.,]+(?= of| rays)/gu)!.map((x) => Number(x.replace(/\D/gu, "")));
    expect([told, all]).toEqual([1234, 1234 + nodes.length]);
    await note.locator("summary").click();
    expect(await note.textContent()).toContain("the rays of 5 more samples");
    expect(await note.textContent()).toContain("-o tree.json");
    await tab.locator("#row-1 .name").click();
    await shows(tab, 1);
    expect(await tab.locator(".inspector .missing").textContent()).toContain("left out of this page");
    expect(await fact(tab, "id in the JSON")).toBe("7");
    await done(opened);
  });
});

describe("ten thousand rays", () => {
  const large: Page = page([brief(tree(10_000))]);

  it("are a file of less than 2 MB that opens, scrolls and selects", async () => {
    const path = write(large, "large");
    expect(statSync(path).size).toBeLessThan(2_000_000);
    const opened = await open(browser, path, { hash: "#tree=outline" });
    const { tab } = opened;
    const count = large.trees[0]!.nodes.length;
    expect(Number(await canvas(tab, "rays"))).toBeGreaterThanOrEqual(count);
    await tab.getByTitle("Open all").click();
    expect(await tab.locator(".row").count()).toBeLessThan(80);
    await tab.keyboard.press("End");
    await shows(tab, count - 1);
    await tab.keyboard.press("Home");
    await shows(tab, 0);
    const began = Date.now();
    for (let i = 0; i < 20; i++) await tab.keyboard.press("ArrowDown");
    await shows(tab, 20);
    console.log(`20 steps down the outline of 10 000 rays: ${Date.now() - began} ms`);
    await tab.getByRole("button", { name: "Slide" }).click();
    await expect.poll(() => tab.locator("canvas.slide").getAttribute("data-shown"), { timeout: 30_000 }).toBe(String(count));
    const rate = await tab.evaluate(() => window.durer!.viewer!.turn(20));
    console.log(`10 000 rays in 3D without a graphics card: ${rate.toFixed(1)} frames per second`);
    await done(opened);
  });
});
