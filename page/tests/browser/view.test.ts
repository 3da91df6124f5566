// `durer view` itself in Debian's Chromium: what the page shows is what durer says elsewhere. Needs DURER_BIN.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser, Page as Tab } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";

import type { Tree } from "../../src/data/types";
import { launch } from "../support/browser";
import { openLive, picture, pixelOf, type OpenedLive } from "../support/liveTab";
import { Program, UPGRADE } from "../support/program";

const durer = process.env["DURER_BIN"] ?? "";
if (durer === "") console.warn("SKIPPED: durer view in a browser: no DURER_BIN; `cargo xtask test` sets it");

const FILM = ["--width", "96", "--height", "54", "--spp", "4"];
const folder = mkdtempSync(join(tmpdir(), "durer-view-"));

let browser: Browser;
let program: Program;
let opened: OpenedLive;
let tab: Tab;

const attribute = (name: string): Promise<string | null> => picture(tab).getAttribute(`data-${name}`);
const finished = async (): Promise<void> => expect.poll(() => attribute("done"), { timeout: 60_000 }).toBe("true");
const calm = (): void => expect([...opened.strangers, ...opened.complaints]).toEqual([]);
const nodes = (): Promise<Tree["nodes"] | undefined> => tab.evaluate(() => window.durerLive!.rays.store.value?.g.value.nodes);

/** Opens a fresh page on the program's scene. */
async function open(words: string[]): Promise<void> {
  program = await Program.start(durer, words);
  opened = await openLive(browser, program.address);
  tab = opened.tab;
}

/** Clicks a pixel of the film. */
async function click(x: number, y: number): Promise<void> {
  const box = (await picture(tab).boundingBox())!;
  const { scale, left, top } = await tab.evaluate(() => window.durerLive!.lying.value);
  await tab.mouse.click(box.x + left + (x + 0.5) * scale, box.y + top + (y + 0.5) * scale);
  await tab.waitForSelector("canvas[data-rays]", { state: "attached", timeout: 60_000 });
}

function traced(scene: string, pixel: string, more: string[] = []): Tree {
  return JSON.parse(execFileSync(durer, ["trace", scene, "--pixel", pixel, ...FILM, "--json", "--quiet", ...more], { maxBuffer: 1 << 28 }).toString()) as Tree;
}

/** All numbers of the rays, as they are told in both places. */
function numbers(list: Tree["nodes"]): unknown[] {
  return list.map(({ kind, parent, origin, direction, t, weight, throughput, contribution, result, stop, object }) =>
    ({ kind, parent, origin, direction, t, weight, throughput, contribution, result, stop, object }));
}

async function enter(form: string, param: string, value: string): Promise<void> {
  const field = tab.locator(`[data-form="${form}"] [data-param="${param}"] input.number`).first();
  await field.fill(value);
  await field.press("Tab");
}

beforeAll(async () => {
  if (durer !== "") browser = await launch();
});
afterAll(() => browser?.close());

describe.skipIf(durer === "")("durer view of whitted", () => {
  beforeEach(() => open(["whitted", ...FILM]));
  afterEach(async () => {
    await opened?.tab.context().close();
    await program?.stop();
  });

  it("refines the picture until all samples are there", async () => {
    const seen = new Set<string>();
    await expect.poll(async () => {
      seen.add(`${await attribute("samples")}`);
      return attribute("done");
    }, { interval: 5, timeout: 60_000 }).toBe("true");
    expect(await attribute("samples")).toBe("4");
    expect(await tab.locator(".status .samples").textContent()).toBe("4 of 4 samples");
    // A reload shows the session's finished picture again.
    await tab.reload();
    await tab.waitForSelector(".picture canvas[data-samples]");
    await finished();
    calm();
  });

  it("changes with the camera, and is the same again when that comes home", async () => {
    await finished();
    const before = await pixelOf(tab, 0.45, 0.47);
    const box = (await picture(tab).boundingBox())!;
    await tab.mouse.move(box.x + 300, box.y + 300);
    await tab.mouse.down();
    await tab.mouse.move(box.x + 480, box.y + 320, { steps: 8 });
    await tab.mouse.up();
    await expect.poll(async () => Number(await attribute("seq"))).toBeGreaterThan(0);
    await finished();
    expect(await pixelOf(tab, 0.45, 0.47)).not.toEqual(before);
    await tab.locator(".tools button", { hasText: "Reset view" }).click();
    await expect.poll(async () => {
      await finished();
      return pixelOf(tab, 0.45, 0.47);
    }).toEqual(before);
    calm();
  });

  it("shows for a click the rays of durer trace, bit by bit, at another depth too, and of another sample", async () => {
    await finished();
    await click(56, 27);
    await expect.poll(async () => numbers((await nodes()) ?? [])).toEqual(numbers(traced("whitted", "56,27").nodes));
    await tab.locator(".sidehead button", { hasText: "Scene" }).click();
    await tab.locator("#tab-render").click();
    await enter("integrator", "maxdepth", "2");
    await expect.poll(async () => numbers((await nodes()) ?? [])).toEqual(numbers(traced("whitted", "56,27", ["--max-depth", "2"]).nodes));
    await tab.locator(".scrub input").fill("3");
    await expect.poll(async () => numbers((await nodes()) ?? [])).toEqual(numbers(traced("whitted", "56,27", ["--max-depth", "2", "--sample", "3"]).nodes));
    // What is written is what is known.
    await tab.locator(".sidehead button", { hasText: "Rays" }).click();
    const shown = await tab.locator('.records [data-fact="result"]').first().textContent();
    expect(shown!.replace(/−/g, "-")).toBe((await nodes())![0]!.result.map(String).join("  "));
    expect(await tab.locator(".formula .differs").allTextContents()).toEqual([]);
    calm();
  });

  it("compares with another integrator on the same sample", async () => {
    await finished();
    await click(56, 27);
    await tab.locator("#tab-compare").click();
    await tab.locator("#rival").selectOption("path");
    await expect.poll(() => tab.locator(".lead").textContent()).toContain("path");
    const rival = await tab.evaluate(() => window.durerLive!.rays.store.value!.rival.value?.tree.integrator);
    expect(rival).toBe("path");
    calm();
  });

  it("takes what is entered: exposure, a colour, a kind; and goes back", async () => {
    await finished();
    await click(56, 50);
    const light = async (): Promise<number> => (await pixelOf(tab, 0.59, 0.7)).slice(0, 3).reduce((a, b) => a + b);
    const before = await light();
    await tab.locator(".sidehead button", { hasText: "Scene" }).click();
    await tab.locator("#tab-look").click();
    await enter("look", "exposure", "-2");
    await expect.poll(light).toBeLessThan(before * 0.8);
    await tab.locator('[data-form="look"] .undo').click();
    await expect.poll(light).toBe(before);
    await tab.locator("#tab-render").click();
    await tab.locator("#kind-integrator").selectOption("path");
    await expect.poll(() => tab.locator('[data-param="roulettedepth"]').count()).toBe(1);
    await expect.poll(() => tab.evaluate(() => window.durerLive!.rays.store.value!.g.value.tree.integrator)).toBe("path");
    await enter("integrator", "maxdepth", "-3");
    expect(await tab.locator('[data-param="maxdepth"] input.number').getAttribute("aria-invalid")).toBe("true");
    await tab.locator("#tab-scene").click();
    await tab.locator("button", { hasText: "All as in the scene" }).click();
    await expect.poll(async () => {
      await finished();
      return light();
    }).toBe(before);
    calm();
  });

  it("tells what is under the mouse in every layer, and opens its material", async () => {
    await finished();
    for (const [layer, says] of [["depth", /m deep/], ["cost", /primitives \+/], ["id", /object \d/], ["normal", /\d/]] as [string, RegExp][]) {
      await tab.locator(".layer select").selectOption(layer);
      await expect.poll(() => attribute("layer")).toBe(layer);
      await finished();
      const box = (await picture(tab).boundingBox())!;
      await tab.mouse.move(box.x + 2, box.y + 200);
      await tab.mouse.move(box.x + box.width * 0.55, box.y + box.height * 0.5);
      await expect.poll(() => tab.locator(".under .read").textContent()).toMatch(says);
    }
    await click(56, 27);
    await expect.poll(() => tab.locator(".status .object b").textContent()).toBe(traced("whitted", "56,27").nodes[0]!.object);
    await tab.mouse.move(3, 3);
    await tab.locator('.status .object button[title="Change this material"]').click();
    await tab.waitForSelector('.folded[open] [data-form^="material/"]');
    calm();
  });

  it("splits the view", async () => {
    await finished();
    await tab.locator('.tools button[title^="Compare"]').click();
    await expect.poll(() => tab.locator(".sides").textContent()).toBe("whittedpath");
    await expect.poll(() => tab.evaluate(() => {
      const other = window.durerLive!.against.value;
      return other?.is === "session" && other.session.picture.value?.header.done;
    }), { timeout: 60_000 }).toBe(true);
    calm();
  });

  it("has two viewers, each with a camera and settings of its own", async () => {
    await finished();
    const second = await openLive(browser, program.address);
    await expect.poll(() => tab.locator(".viewers").textContent()).toBe("2 viewers");
    await expect.poll(() => picture(second.tab).getAttribute("data-done"), { timeout: 60_000 }).toBe("true");
    const before = await pixelOf(second.tab, 0.45, 0.47);
    await tab.locator(".layer select").selectOption("normal");
    await expect.poll(() => attribute("layer")).toBe("normal");
    await picture(tab).focus();
    await tab.keyboard.press("j");
    await expect.poll(async () => Number(await attribute("seq"))).toBeGreaterThan(0);
    await expect.poll(() => picture(second.tab).getAttribute("data-done"), { timeout: 60_000 }).toBe("true");
    expect(await picture(second.tab).getAttribute("data-layer")).toBe("beauty");
    expect(await picture(second.tab).getAttribute("data-seq")).toBe("0");
    expect(await pixelOf(second.tab, 0.45, 0.47)).toEqual(before);
    await second.tab.context().close();
    await tab.waitForSelector(".viewers", { state: "detached" });
    calm();
  });

  it("goes on after the connection broke, as it was", async () => {
    await finished();
    await picture(tab).focus();
    await tab.keyboard.press("l");
    await expect.poll(async () => Number(await attribute("seq"))).toBe(1);
    const eye = await tab.evaluate(() => window.durerLive!.main.camera.value!.eye);
    await tab.evaluate(() => (window.durerLive!.main.link as unknown as { socket: WebSocket }).socket.close(4000));
    await expect.poll(() => tab.evaluate(() => window.durerLive!.main.link.state.value.is)).toBe("open");
    const again = await tab.evaluate(() => window.durerLive!.main.camera.value!.eye);
    again.forEach((x, i) => expect(x).toBeCloseTo(eye[i]!, 4));
    calm();
  });

  it("saves the picture and the scene", async () => {
    await finished();
    const save = async (word: string): Promise<Buffer> => {
      const [file] = await Promise.all([tab.waitForEvent("download"), tab.locator("button", { hasText: new RegExp(`^${word}$`) }).click()]);
      return readFileSync(await file.path());
    };
    expect((await save("PNG")).subarray(1, 4).toString()).toBe("PNG");
    expect((await save("EXR")).readUInt32LE(0)).toBe(20_000_630);
    calm();
  });

  it("stops at Ctrl-C; the page says so and keeps the picture", async () => {
    await finished();
    const before = await pixelOf(tab, 0.45, 0.47);
    expect([0, 130]).toContain(await program.stop());
    await tab.waitForSelector('[data-about="connection"]');
    expect(await pixelOf(tab, 0.45, 0.47)).toEqual(before);
  });
});

const room = (color: string): string => `LookAt 0 1 5  0 0 0  0 1 0
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 64 "integer yresolution" 48
Sampler "independent" "integer pixelsamples" 2
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "diffuse" "rgb reflectance" [${color}]
Shape "sphere" "float radius" 1
`;

describe.skipIf(durer === "")("durer view of a file that changes", () => {
  const path = join(folder, "room.pbrt");
  beforeEach(async () => {
    writeFileSync(path, room("0.8 0.1 0.1"));
    await open([path]);
  });
  afterEach(async () => {
    await opened?.tab.context().close();
    await program?.stop();
  });

  it("reads it again; an error is shown over the old picture until it is mended", async () => {
    await finished();
    expect((await pixelOf(tab, 0.49, 0.47))[0]).toBeGreaterThan((await pixelOf(tab, 0.49, 0.47))[1]! * 1.5);
    writeFileSync(path, room("0.1 0.8 0.1"));
    await expect.poll(() => attribute("revision"), { timeout: 60_000 }).toBe("2");
    await finished();
    const green = await pixelOf(tab, 0.49, 0.47);
    expect(green[1]).toBeGreaterThan(green[0]! * 1.5);
    writeFileSync(path, room("0.1 0.1 0.8").replace('"diffuse"', '"difuse"'));
    await expect.poll(() => tab.locator('[data-about="scene"] pre').textContent(), { timeout: 60_000 }).toContain("difuse");
    expect(await pixelOf(tab, 0.49, 0.47)).toEqual(green);
    writeFileSync(path, room("0.1 0.1 0.8"));
    await tab.waitForSelector('[data-about="scene"]', { state: "detached", timeout: 60_000 });
    await expect.poll(async () => {
      await finished();
      const blue = await pixelOf(tab, 0.49, 0.47);
      return blue[2]! > blue[0]! * 1.5;
    }).toBe(true);
    calm();
  });

  it("writes the changed scene as pbrt, which is read again", async () => {
    await finished();
    await tab.locator("#tab-materials").click();
    if ((await tab.locator('[data-form="material/0"]').count()) === 0) await tab.locator(".folded summary").first().click();
    await tab.locator('[data-form="material/0"] input[type="color"]').fill("#00ff00");
    await expect.poll(async () => {
      await finished();
      const [r, g] = await pixelOf(tab, 0.49, 0.47);
      return g! > 2 * r!;
    }).toBe(true);
    await tab.locator("#tab-look").click();
    const [file] = await Promise.all([tab.waitForEvent("download"), tab.locator("button", { hasText: ".pbrt" }).click()]);
    const saved = join(folder, "saved.pbrt");
    await file.saveAs(saved);
    const text = execFileSync(durer, ["trace", saved, "--pixel", "32,24", "--json", "--quiet"]).toString();
    const { rgb } = JSON.parse(text) as Tree;
    expect(rgb[1]).toBeGreaterThan(10 * rgb[0]);
    calm();
  });
});

describe.skipIf(durer === "")("the door of durer view", () => {
  beforeAll(() => open(["whitted", ...FILM]));
  afterAll(async () => {
    await opened?.tab.context().close();
    await program?.stop();
  });
  const page = (token = program.token): string => `/?token=${token}`;

  it("opens to the page itself, under a policy that lets nothing else in", async () => {
    const { status, headers, body } = await program.ask(page());
    expect(status).toBe(200);
    const policy = String(headers["content-security-policy"]);
    expect(policy).toContain("default-src 'none'");
    expect(policy).not.toContain("unsafe");
    expect(headers["access-control-allow-origin"]).toBeUndefined();
    const nonce = /'nonce-([^']+)'/.exec(policy)![1]!;
    expect(body.split(nonce).length).toBe(3);
    expect((await program.ask(page())).headers["content-security-policy"]).not.toBe(policy);
  });

  it("is shut to wrong tokens", async () => {
    for (const path of ["/", "/?token=", page("0".repeat(program.token.length)), page(program.token.slice(0, -1)), `/socket`, `/save?format=png`]) {
      expect((await program.ask(path)).status, path).toBe(403);
    }
    expect((await program.ask("/socket?token=x", { headers: UPGRADE })).status).toBe(403);
  });

  it("is shut to foreign hosts and origins", async () => {
    const port = program.url.port;
    for (const Host of ["evil.example", `evil.example:${port}`, "127.0.0.1:1", `127.0.0.1.evil.example:${port}`]) {
      expect((await program.ask(page(), { headers: { Host } })).status, Host).toBe(403);
    }
    for (const Origin of ["http://evil.example", "null", `http://evil.example:${port}`, `https://127.0.0.1:${port}`]) {
      expect((await program.ask(page(), { headers: { Origin } })).status, Origin).toBe(403);
      expect((await program.ask(`/socket?token=${program.token}`, { headers: { ...UPGRADE, Origin } })).status, Origin).toBe(403);
    }
    const Origin = `http://127.0.0.1:${port}`;
    expect((await program.ask(`/socket?token=${program.token}`, { headers: { ...UPGRADE, Origin } })).status).toBe(101);
  });

  it("is shut to a page of another origin, in the browser too", async () => {
    const stranger = await tab.context().newPage();
    await stranger.goto("about:blank");
    const address = `ws://127.0.0.1:${program.url.port}/socket?token=${program.token}`;
    expect(await stranger.evaluate((to) => new Promise((done) => {
      const socket = new WebSocket(to);
      socket.onopen = () => done("open");
      socket.onerror = () => done("refused");
    }), address)).toBe("refused");
    expect(await stranger.evaluate((to) => fetch(to).then(() => "read", () => "refused"), program.address)).toBe("refused");
    await stranger.close();
  });

  it("leads to no file", async () => {
    const words = `?token=${program.token}`;
    for (const path of ["/etc/passwd", "/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc%2fpasswd", "/Cargo.toml", "//etc/passwd", "/index.html", "/./"]) {
      const { status, body } = await program.ask(path + words);
      expect([400, 403, 404], path).toContain(status);
      expect(body).not.toContain("root:");
    }
    for (const method of ["POST", "PUT", "DELETE", "OPTIONS"]) expect((await program.ask(page(), { method })).status, method).toBe(405);
  });
});
