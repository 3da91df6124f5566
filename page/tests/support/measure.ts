// How fast pages are in a browser, as JSON: vite-node tests/support/measure.ts FILE.html ... A file that is not there but
// called synthetic.html is made of 10,000 rays. For `cargo xtask bench view`, which asserts nothing.
import { existsSync, statSync } from "node:fs";
import { basename } from "node:path";
import type { Browser } from "playwright-core";

import { launch, open } from "./browser";
import { write } from "./fill";
import { brief, page, tree } from "./synthetic";

const FRAMES = 20;
const STEPS = 21;

interface Figures {
  page: string;
  bytes: number;
  /** Rays of all trees, and of the tree that is shown. */
  rays: number;
  shown: number;
  /** Seconds from going to the address to the first picture. */
  opened: number;
  /** Frames per second while the camera turns once around the rays. */
  fps: number;
  /** Draw calls of a frame while it turns, and at rest. */
  calls: { turning: number; resting: number };
  /** Seconds from pressing a key to a finished frame with the next ray selected: median and worst. */
  step: { median: number; worst: number };
  /** Who draws, as WebGL calls it. */
  renderer: string;
}

async function measure(browser: Browser, path: string): Promise<Figures> {
  const began = performance.now();
  const { tab, requests, complaints } = await open(browser, path, { hash: "#tree=outline" });
  const opened = (performance.now() - began) / 1000;
  const [rays, shown] = await tab.evaluate(() => {
    const { store } = window.durer!;
    return [store.page.trees.reduce((sum, one) => sum + one.nodes.length, 0), store.g.peek().nodes.length] as const;
  });
  // A warm-up, so that shaders are compiled.
  await tab.evaluate(() => window.durer!.viewer!.turn(5));
  const fps = await tab.evaluate((frames) => window.durer!.viewer!.turn(frames), FRAMES);
  const calls = (): Promise<number> => tab.evaluate(() => window.durer!.viewer!["renderer"].info.render.calls);
  const turning = await calls();
  await tab.waitForTimeout(1500);
  const resting = await calls();
  const steps = await tab.evaluate(async (count) => {
    const frame = (): Promise<number> => new Promise((done) => requestAnimationFrame(done));
    const { store, viewer } = window.durer!;
    const gl = viewer!["renderer"].getContext();
    const canvas = document.querySelector<HTMLElement>(".view canvas")!;
    const times: number[] = [];
    for (let i = 0; i < count; i++) {
      const start = performance.now();
      dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowDown" }));
      const id = store.selected.peek();
      while (!document.querySelector(`.inspector[data-node="${id}"]`) || canvas.dataset["selected"] !== String(id)) await frame();
      // The frame that shows it, and its end.
      await frame();
      gl.finish();
      times.push((performance.now() - start) / 1000);
    }
    return times.sort((a, b) => a - b);
  }, STEPS);
  const renderer = await tab.evaluate(() => {
    const gl = window.durer!.viewer!["renderer"].getContext();
    const told = gl.getExtension("WEBGL_debug_renderer_info");
    return String(gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  });
  for (const complaint of [...requests, ...complaints]) console.error(`${path}: ${complaint}`);
  await tab.context().close();
  return {
    page: basename(path, ".html"), bytes: statSync(path).size, rays, shown, opened, fps, calls: { turning, resting },
    step: { median: steps[Math.floor(steps.length / 2)]!, worst: steps.at(-1)! }, renderer,
  };
}

/** The file, or one made here. */
function found(path: string): string {
  if (existsSync(path) || basename(path) !== "synthetic.html") return path;
  return write(page([brief(tree(10_000))]), "synthetic");
}

const browser = await launch();
const all: Figures[] = [];
for (const path of process.argv.slice(2)) all.push(await measure(browser, found(path)));
await browser.close();
console.log(JSON.stringify(all));
