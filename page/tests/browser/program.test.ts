// Pages that durer itself writes: what they show is what `durer trace --json` prints. Needs DURER_BIN.
import { execFileSync } from "node:child_process";
import { mkdtempSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";

import type { Tree } from "../../src/data/types";
import { launch, open } from "../support/browser";

const durer = process.env["DURER_BIN"] ?? "";
if (durer === "") console.warn("SKIPPED: pages written by durer: no DURER_BIN; `cargo xtask test` sets it");

/** What is traced: all integrators with trees, glass, lenses, and a comparison. */
const TRACES: [string, string[]][] = [
  ["whitted", ["whitted", "--pixel", "370,200", "--width", "640", "--height", "360", "--spp", "2"]],
  ["beaker", ["beaker", "--pixel", "300,200", "--width", "640", "--height", "480", "--spp", "2"]],
  ["cook", ["cook", "--pixel", "100,60", "--width", "320", "--height", "240", "--spp", "4"]],
];

describe.skipIf(durer === "")("a page that durer writes", () => {
  let browser: Browser;
  const folder = mkdtempSync(join(tmpdir(), "durer-page-"));
  beforeAll(async () => {
    browser = await launch();
  });
  afterAll(() => browser?.close());

  for (const [name, words] of TRACES) {
    it(`of ${name} shows the numbers of the JSON`, async () => {
      const path = join(folder, `${name}.html`);
      const traced = execFileSync(durer, ["trace", ...words, "--json", "-o", path, "--quiet"], { maxBuffer: 1 << 28 });
      const tree = JSON.parse(traced.toString()) as Tree;
      expect(statSync(path).size).toBeLessThan(2_000_000);
      const { tab, requests, complaints } = await open(browser, path, { hash: "#tree=outline" });
      for (const node of tree.nodes.slice(0, 40)) {
        await tab.locator(`#row-${node.id} .name`).click();
        await tab.waitForSelector(`.inspector[data-node="${node.id}"]`);
        const shown = await tab.locator('.records [data-fact="result"]').first().textContent();
        expect(shown!.replace(/−/g, "-")).toBe(node.result.map(String).join("  "));
        expect(await tab.locator(".formula .differs").allTextContents(), `ray ${node.id}`).toEqual([]);
      }
      expect([...requests, ...complaints]).toEqual([]);
      await tab.context().close();
    });
  }

  it("of two depth limits shows what changes", async () => {
    const path = join(folder, "diff.html");
    execFileSync(durer, ["trace", ...TRACES[0]![1], "--diff", "--max-depth 2", "-o", path, "--quiet"], { maxBuffer: 1 << 28 });
    const { tab, complaints } = await open(browser, path, { hash: "#view=compare" });
    expect(await tab.locator(".lead").textContent()).toContain("--max-depth 2");
    expect(await tab.locator(".changes li").count()).toBeGreaterThan(3);
    expect(complaints).toEqual([]);
    await tab.context().close();
  });
});
