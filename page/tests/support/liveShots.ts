// Screenshots of the live page, to be looked at: SHOTS=folder [ADDRESS=http://...] npx vite-node tests/support/liveShots.ts
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import type { Page as Tab } from "playwright-core";

import { launch } from "./browser";
import { whitted } from "./fixture";
import { Mock } from "./mock";

const folder = process.env["SHOTS"] ?? "shots";
const only = process.env["ONLY"];
mkdirSync(folder, { recursive: true });
const browser = await launch();
let mock: Mock | null = null;

const tab = (name: string) => async (page: Tab): Promise<void> => page.locator(`#tab-${name}`).click();
const trace = async (page: Tab): Promise<void> => {
  const box = (await page.locator(".picture canvas").boundingBox())!;
  await page.mouse.click(box.x + box.width * Number(process.env["X"] ?? 0.5), box.y + box.height * Number(process.env["Y"] ?? 0.5));
  await page.waitForSelector("canvas[data-rays]", { state: "attached", timeout: 60_000 });
};
const SCENES: [string, (page: Tab) => Promise<void>][] = [
  ["look", async () => undefined],
  ["render", tab("render")],
  ["camera", tab("camera")],
  ["lights", async (page) => { await tab("lights")(page); await page.locator(".folded summary").first().click(); }],
  ["materials", async (page) => { await tab("materials")(page); await page.locator(".folded summary").first().click(); }],
  ["scene", tab("scene")],
  ["rays", trace],
  ["space", async (page) => { await trace(page); const three = page.locator(".header .choice button").last(); if (await three.isVisible()) await three.click(); }],
  ["compare", async (page) => { await trace(page); await tab("compare")(page); await page.locator("#rival").selectOption({ index: 2 }); }],
  ["samples", async (page) => { await trace(page); await tab("samples")(page); }],
  ["machine", async (page) => { await trace(page); await tab("machine")(page); }],
  ["split", async (page) => { await page.locator('.tools button[title^="Compare"]').click(); await page.waitForSelector(".divider"); }],
  ["cost", async (page) => { await page.locator(".layer select").selectOption("cost"); const box = (await page.locator(".picture canvas").boundingBox())!; await page.mouse.move(box.x + box.width * 0.4, box.y + box.height * 0.5); }],
  ["help", async (page) => page.keyboard.press("?")],
  ["error", async (page) => { mock?.fail("whitted.pbrt:12:7: unknown material kind `difuse`\n  hint: did you mean `diffuse`?"); await page.waitForTimeout(50); }],
  ["lost", async (page) => { mock?.stop(); await page.waitForTimeout(2500); }],
];
const sizes: [number, number, boolean][] = [[390, 844, false], [390, 844, true], [820, 1180, false], [1280, 800, false], [1280, 800, true], [1920, 1080, false]];
for (const [name, act] of SCENES) {
  for (const [width, height, dark] of sizes) {
    const full = `${width}-${dark ? "dark" : "light"}-${name}`;
    if (only && !full.match(only)) continue;
    mock = process.env["ADDRESS"] ? null : await new Mock(whitted()).start();
    const address = mock?.address ?? process.env["ADDRESS"]!;
    const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", reducedMotion: "reduce" });
    const page = await context.newPage();
    page.on("console", (message) => /error|warning/.test(message.type()) && !/GPU stall|GL Driver/.test(message.text()) && console.error(full, message.text()));
    page.on("pageerror", (error) => console.error(full, error));
    await page.goto(address);
    await page.waitForSelector(".picture canvas[data-samples]");
    await page.waitForTimeout(700);
    await act(page);
    await page.waitForTimeout(1300);
    await page.screenshot({ path: join(folder, `${full}.png`) });
    await context.close();
    mock?.stop();
  }
}
await browser.close();
