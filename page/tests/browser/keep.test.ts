// `durer view` in Debian's Chromium: what is kept of a session - scenes with their files, light to compare with, changes that
// outlive the file's - and the layers of what samples are like. Needs DURER_BIN.
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser, Page as Tab } from "playwright-core";
import { afterAll, afterEach, beforeAll, describe, expect, it } from "vitest";

import { launch } from "../support/browser";
import { openLive, picture, pixelOf, type OpenedLive } from "../support/liveTab";
import { Program } from "../support/program";

const durer = process.env["DURER_BIN"] ?? "";
const FILM = ["--width", "96", "--height", "54", "--spp", "4"];
const folder = mkdtempSync(join(tmpdir(), "durer-keep-"));
const shots = process.env["DURER_SHOTS"] ?? "";

let browser: Browser;
let program: Program;
let opened: OpenedLive;
let tab: Tab;

const attribute = (name: string): Promise<string | null> => picture(tab).getAttribute(`data-${name}`);
const finished = async (): Promise<void> => expect.poll(() => attribute("done"), { timeout: 60_000 }).toBe("true");
const calm = (): void => expect([...opened.strangers, ...opened.complaints]).toEqual([]);

async function open(words: string[]): Promise<void> {
  program = await Program.start(durer, words);
  opened = await openLive(browser, program.address);
  tab = opened.tab;
}

/** For eyes. */
async function shot(name: string): Promise<void> {
  if (shots === "") return;
  mkdirSync(shots, { recursive: true });
  await tab.screenshot({ path: join(shots, `${name}.png`) });
}

async function saved(button: string): Promise<string> {
  const [file] = await Promise.all([tab.waitForEvent("download"), tab.getByRole("button", { name: button, exact: true }).click()]);
  const path = join(folder, file.suggestedFilename());
  await file.saveAs(path);
  return path;
}

describe.skipIf(durer === "")("what is kept of durer view", () => {
  beforeAll(async () => {
    browser = await launch();
  });
  afterAll(() => browser?.close());
  afterEach(async () => {
    await opened?.tab.context().close();
    await program?.stop();
  });

  it("a scene whose picture lies within it is saved as an archive", async () => {
    const scene = join(folder, "leaf.gltf");
    copyFileSync("../crates/view/tests/live/scenes/leaf-with-picture.gltf", scene);
    await open([scene, ...FILM]);
    await finished();
    const path = await saved(".pbrt");
    expect(path).toMatch(/leaf\.zip$/);
    const bytes = readFileSync(path);
    expect(bytes.subarray(0, 2).toString()).toBe("PK");
    expect(bytes.includes("leaf-files/image-0.png")).toBe(true);
    await shot("saved");
    calm();
  });

  it("any scene is saved with its files as an archive", async () => {
    await open(["whitted", ...FILM]);
    await finished();
    expect(await saved(".pbrt")).toMatch(/whitted\.pbrt$/);
    const path = await saved(".zip");
    expect(readFileSync(path).includes("whitted.pbrt")).toBe(true);
    calm();
  });

  it("light is compared as this picture is shown, also when that changes", async () => {
    await open(["cornell", "--integrator", "path", ...FILM]);
    await finished();
    const exr = await saved("EXR");
    await tab.locator('input[type="file"]').setInputFiles(exr);
    await expect.poll(() => tab.evaluate(() => window.durerLive!.against.value?.is)).toBe("image");
    // The same light is the same colour right of the line as left of it.
    const alike = async (): Promise<void> => {
      const [left, right] = [await pixelOf(tab, 0.47, 0.2), await pixelOf(tab, 0.53, 0.2)];
      for (let i = 0; i < 3; i++) expect(Math.abs(left[i]! - right[i]!), `${left} ${right}`).toBeLessThan(25);
    };
    await alike();
    const before = await pixelOf(tab, 0.53, 0.2);
    await shot("light");
    const field = tab.locator('[data-form="look"] [data-param="exposure"] input.number').first();
    await field.fill("-3");
    await field.press("Tab");
    await expect.poll(async () => (await pixelOf(tab, 0.53, 0.2))[0]! < before[0]! - 30, { timeout: 20_000 }).toBe(true);
    await alike();
    await shot("darker");
    // What is no picture is named, with the reason.
    const nothing = join(folder, "nothing.exr");
    writeFileSync(nothing, "not light");
    await tab.locator('input[type="file"]').setInputFiles(nothing);
    await expect.poll(() => tab.locator("p.wrong").textContent()).toContain("nothing.exr: ");
    await shot("no-light");
  });

  it("rays and noise are layers with a scale and numbers", async () => {
    await open(["whitted", ...FILM]);
    for (const [layer, scale, words] of [["rays", /^0.*rays/, "rays per sample"], ["noise", /^0.*±/, "±"]] as const) {
      await tab.getByRole("button", { name: layer, exact: true }).click();
      await expect.poll(() => attribute("layer")).toBe(layer);
      await finished();
      expect(await tab.locator("p.scale").textContent()).toMatch(scale);
      const box = (await picture(tab).boundingBox())!;
      await tab.mouse.move(box.x + box.width * 0.49, box.y + box.height * 0.47);
      await expect.poll(() => tab.locator("p.under").textContent(), { timeout: 20_000 }).toContain(words);
      await shot(layer);
    }
    calm();
  });

  it("changes outlive those of the file, and what is gone is named", async () => {
    const path = join(folder, "room.pbrt");
    const room = (color: string, light: number): string => `LookAt 0 1 5  0 0 0  0 1 0
Camera "perspective" "float fov" 45
WorldBegin
LightSource "infinite" "rgb L" [${light} ${light} ${light}]
MakeNamedMaterial "paint" "string type" "diffuse" "rgb reflectance" [${color}]
NamedMaterial "paint"
Shape "sphere" "float radius" 1
`;
    writeFileSync(path, room("0.8 0.1 0.1", 1));
    await open([path, ...FILM]);
    await finished();
    await tab.locator("#tab-materials").click();
    if ((await tab.locator('[data-form="material/0"]').count()) === 0) await tab.locator(".folded summary").first().click();
    await tab.locator('[data-form="material/0"] input[type="color"]').fill("#00ff00");
    const green = async (): Promise<boolean> => {
      await finished();
      const [r, g] = await pixelOf(tab, 0.49, 0.47);
      return g! > 2 * r!;
    };
    await expect.poll(green).toBe(true);
    writeFileSync(path, room("0.8 0.1 0.1", 0.7));
    await expect.poll(() => attribute("revision"), { timeout: 60_000 }).toBe("2");
    expect(await green()).toBe(true);
    expect(await tab.locator('[data-about="scene"]').count()).toBe(0);
    writeFileSync(path, room("0.1 0.1 0.8", 0.7));
    await expect.poll(() => attribute("revision"), { timeout: 60_000 }).toBe("3");
    expect(await green()).toBe(false);
    expect(await tab.locator('[data-about="scene"]').textContent()).toContain('"paint"');
    await shot("gone");
    calm();
  });
});
