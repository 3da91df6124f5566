// The live page in Debian's Chromium, against a stand-in for `durer view` that says what the protocol says.
import type { Browser, Page as Tab } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";

import { launch } from "../support/browser";
import { whitted } from "../support/fixture";
import { frames, openLive, picture, pixelOf, type OpenedLive } from "../support/liveTab";
import { Mock } from "../support/mock";

let browser: Browser;
let mock: Mock;
let opened: OpenedLive;
let tab: Tab;
const rays = whitted();

beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());
beforeEach(async () => {
  mock = await new Mock(rays).start();
  opened = await openLive(browser, mock.address);
  tab = opened.tab;
});
afterEach(async () => {
  await opened.tab.context().close();
  mock.stop();
});

const sent = (type: string) => mock.heard.filter((message) => message.type === type);
const last = (type: string) => sent(type).at(-1);
const calm = (): void => expect([...opened.strangers, ...opened.complaints]).toEqual([]);

/** Clicks the middle of the picture and waits for the rays. */
async function click(): Promise<void> {
  const box = (await picture(tab).boundingBox())!;
  await tab.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await tab.waitForSelector("canvas[data-rays]", { state: "attached" });
}

describe("the live picture", () => {
  it("gets better while it is watched, and each frame is acknowledged once", async () => {
    await expect.poll(() => picture(tab).getAttribute("data-done")).toBe("true");
    expect(await tab.locator(".status .state").textContent()).toContain("8 of 8 samples");
    await expect.poll(() => mock.acks.length).toBeGreaterThanOrEqual(8);
    expect(new Set(mock.acks).size).toBe(mock.acks.length);
    expect(await tab.title()).toBe("balls – durer");
    calm();
  });

  it("follows the mouse: orbit, shift, nearer; and goes back to the scene's own camera", async () => {
    const box = (await picture(tab).boundingBox())!;
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await expect.poll(() => picture(tab).getAttribute("data-done")).toBe("true");
    const before = await pixelOf(tab, 0.49, 0.47);
    await tab.mouse.move(x, y);
    await tab.mouse.down();
    await tab.mouse.move(x + 150, y + 10, { steps: 6 });
    await tab.mouse.up();
    await expect.poll(() => sent("camera").length).toBeGreaterThan(1);
    const turned = last("camera") as unknown as { eye: number[]; forward: number[]; seq: number };
    expect(turned.eye[0]).toBeLessThan(-0.5);
    await expect.poll(() => picture(tab).getAttribute("data-seq")).toBe(String(turned.seq));
    expect(sent("trace"), "a drag is no click").toEqual([]);
    await tab.mouse.wheel(0, -300);
    await expect.poll(() => Math.hypot(...(last("camera")!["eye"] as number[]))).toBeLessThan(Math.hypot(...turned.eye) - 0.5);
    await tab.locator(".tools button", { hasText: "Reset view" }).click();
    await expect.poll(() => last("camera")!["name"]).toBe(null);
    await expect.poll(() => picture(tab).getAttribute("data-done")).toBe("true");
    expect(await pixelOf(tab, 0.49, 0.47)).toEqual(before);
    calm();
  });

  it("is steered by the keyboard alone", async () => {
    await picture(tab).focus();
    await tab.keyboard.press("j");
    await tab.keyboard.press("w");
    await expect.poll(() => sent("camera").length).toBeGreaterThan(0);
    await tab.keyboard.press("8");
    await expect.poll(() => picture(tab).getAttribute("data-layer")).toBe("cost");
    await tab.keyboard.press("ArrowRight");
    await tab.keyboard.press("Shift+ArrowDown");
    await expect.poll(() => tab.locator(".under").getAttribute("data-pixel")).toBe("161,100");
    expect(await tab.locator(".under .read").textContent()).toBe("17 primitives + 23 boxes tested");
    await tab.keyboard.press("Enter");
    await tab.waitForSelector("canvas[data-rays]", { state: "attached" });
    expect(last("trace")).toMatchObject({ x: 161, y: 100 });
    await tab.keyboard.press("Escape");
    await tab.waitForSelector("canvas[data-rays]", { state: "detached" });
    await tab.keyboard.press("?");
    await tab.waitForSelector("dialog.help[open]");
    expect(await tab.locator("dialog.help").textContent()).toContain("the scene’s own camera");
    calm();
  });

  it("is magnified without moving the camera, down to single pixels", async () => {
    await tab.locator(".tools button", { hasText: "Magnify" }).click();
    const box = (await picture(tab).boundingBox())!;
    await tab.mouse.move(box.x + box.width * 0.5, box.y + box.height * 0.5);
    for (let i = 0; i < 14; i++) await tab.mouse.wheel(0, -200);
    await expect.poll(() => tab.evaluate(() => window.durerLive!.zoom.value?.scale)).toBe(64);
    expect(sent("camera")).toEqual([]);
    await tab.keyboard.press("0");
    await expect.poll(() => tab.evaluate(() => window.durerLive!.zoom.value)).toBe(null);
    calm();
  });

  it("is split against another integrator, by a line that is dragged", async () => {
    await tab.locator('.tools button[title^="Compare"]').click();
    await tab.waitForSelector(".divider");
    await expect.poll(() => last("kind")).toMatchObject({ form: "integrator", kind: "path" });
    expect(mock.viewers).toBe(2);
    await expect.poll(() => tab.locator(".sides").textContent()).toBe("whittedpath");
    const line = (await tab.locator(".divider").boundingBox())!;
    await tab.mouse.move(line.x + line.width / 2, line.y + 300);
    await tab.mouse.down();
    await tab.mouse.move(line.x - 200, line.y + 300, { steps: 4 });
    await tab.mouse.up();
    expect(Number(await tab.locator(".divider").getAttribute("aria-valuenow"))).toBeLessThan(40);
    const cameras = sent("camera").length;
    await picture(tab).focus();
    await tab.keyboard.press("l");
    // Both sides are told.
    await expect.poll(() => sent("camera").length).toBe(cameras + 2);
    await tab.keyboard.press("v");
    await tab.waitForSelector(".divider", { state: "detached" });
    await expect.poll(() => mock.viewers).toBe(1);
    calm();
  });

  it("is split against what it was before a change", async () => {
    await tab.locator("button", { hasText: "this, as it is" }).click();
    await tab.waitForSelector(".divider");
    await tab.locator("#tab-materials").click();
    await tab.locator(".folded summary", { hasText: "red" }).click();
    await tab.locator('[data-form="material/0"] input[type="color"]').fill("#0000ff");
    await expect.poll(() => last("set")).toMatchObject({ form: "material/0", param: "reflectance", value: [0, 0, 1] });
    // The left of the middle is blue now, the right still red.
    await expect.poll(async () => (await pixelOf(tab, 0.47, 0.55))[2]).toBeGreaterThan(100);
    expect((await pixelOf(tab, 0.53, 0.55))[0]).toBeGreaterThan(100);
    calm();
  });
});

describe("forms", () => {
  it("have a field for each parameter and send what is entered", async () => {
    await tab.locator("#tab-render").click();
    const depth = tab.locator('[data-form="integrator"] [data-param="maxdepth"]');
    await depth.locator("input.number").fill("2");
    await depth.locator("input.number").press("Tab");
    await expect.poll(() => last("set")).toMatchObject({ form: "integrator", param: "maxdepth", value: 2 });
    await depth.locator(".back").click();
    await expect.poll(() => last("set")).toMatchObject({ param: "maxdepth", value: null });
    await tab.locator('[data-param="roulette"] input').uncheck();
    await expect.poll(() => last("set")).toMatchObject({ param: "roulette", value: false });
    await tab.locator("#kind-integrator").selectOption("path");
    await expect.poll(() => last("kind")).toMatchObject({ form: "integrator", kind: "path" });
    await tab.locator('[data-form="integrator"] .undo').click();
    await expect.poll(() => last("reset")).toMatchObject({ form: "integrator" });
    calm();
  });

  it("take textures, spectra, black bodies and points as they are, and keep what is no number to themselves", async () => {
    await tab.locator("#tab-materials").click();
    await tab.locator(".folded summary", { hasText: "red" }).click();
    await tab.locator('[data-param="reflectance"] select').selectOption("wood");
    await expect.poll(() => last("set")).toMatchObject({ param: "reflectance", value: { texture: "wood" } });
    expect(await tab.locator('[data-param="eta"]').textContent()).toContain("spectrum glass-BK7");
    const alpha = tab.locator('[data-param="alpha"] input.number');
    const before = mock.heard.length;
    await alpha.fill("minus");
    await alpha.press("Tab");
    expect(await alpha.getAttribute("aria-invalid")).toBe("true");
    expect(mock.heard.slice(before).filter(({ type }) => type === "set")).toEqual([]);
    await tab.locator("#tab-lights").click();
    if (!(await tab.locator('[data-form="light/0"]').isVisible())) await tab.locator(".folded summary", { hasText: "sun" }).click();
    await tab.locator('[data-param="L"] input.number').fill("3200");
    await tab.locator('[data-param="L"] input.number').press("Tab");
    await expect.poll(() => last("set")).toMatchObject({ form: "light/0", value: { blackbody: 3200 } });
    await tab.locator('[data-param="from"] input').nth(1).fill("7");
    await tab.locator('[data-param="from"] input').nth(1).press("Tab");
    await expect.poll(() => last("set")).toMatchObject({ param: "from", value: [0, 7, 0] });
    // What is being typed is not lost when the program tells of another form.
    await tab.locator('[data-param="from"] input').nth(2).pressSequentially("3");
    await tab.evaluate(() => window.durerLive!.main.set("light/0", "scale", 3));
    await expect.poll(() => tab.locator('[data-param="scale"] input.number').inputValue()).toBe("3");
    await tab.locator('[data-param="from"] input').nth(2).press("Tab");
    await expect.poll(() => last("set")).toMatchObject({ param: "from" });
    expect(String((last("set")!["value"] as number[])[2])).toContain("3");
    calm();
  });

  it("show what the program refuses at the field, and the value that counts", async () => {
    mock.refuse = { message: "exposure must be at most 10", hint: "EV" };
    const exposure = tab.locator('[data-param="exposure"] input.number');
    await exposure.fill("3");
    await exposure.press("Tab");
    await expect.poll(() => tab.locator('[data-form="look"] .wrong').textContent()).toContain("at most 10");
    expect(await exposure.inputValue()).toBe("0");
    calm();
  });

  it("send only the newest value while a slider is dragged", async () => {
    const slider = (await tab.locator('[data-param="exposure"] input[type="range"]').boundingBox())!;
    await tab.mouse.move(slider.x + slider.width / 2, slider.y + slider.height / 2);
    await tab.mouse.down();
    await tab.mouse.move(slider.x + slider.width - 2, slider.y + slider.height / 2, { steps: 40 });
    await tab.mouse.up();
    await expect.poll(async () => String(last("set")!["value"])).toBe(await tab.locator('[data-param="exposure"] input.number').inputValue());
    expect(Number(last("set")!["value"])).toBeGreaterThan(8);
    calm();
  });
});

describe("a clicked pixel", () => {
  it("shows its ray tree in all views, and what was hit", async () => {
    await click();
    expect(last("trace")).toMatchObject({ x: 160, diff: null });
    for (const name of ["ray", "play", "samples", "numbers", "compare", "walk", "machine"]) {
      await tab.locator(`#tab-${name}`).click();
      expect((await tab.locator("#panel").textContent())!.length, name).toBeGreaterThan(30);
    }
    await tab.locator(".choice button", { hasText: "Outline" }).click();
    await tab.locator("#tab-ray").click();
    for (const node of rays.trees[0]!.nodes.slice(0, 12)) {
      await tab.locator(`#row-${node.id} .name`).click();
      await tab.waitForSelector(`.inspector[data-node="${node.id}"]`);
      const shown = await tab.locator('.records [data-fact="result"]').first().textContent();
      expect(shown!.replace(/−/g, "-")).toBe(node.result.map(String).join("  "));
    }
    await tab.mouse.move(5, 5);
    await tab.locator(".status .object button", { hasText: "red" }).click();
    await tab.waitForSelector('[data-form="material/0"]');
    calm();
  });

  it("is traced anew when the depth changes; the chosen ray, the tab and the 3D view stay", async () => {
    await click();
    const all = rays.trees[0]!.nodes.length;
    await expect.poll(() => tab.locator(".tally").textContent()).toContain(`${all} rays`);
    await tab.evaluate(() => window.durerLive!.rays.store.value!.select(2));
    const stage = await tab.locator(".space").getAttribute("data-stage");
    await tab.locator(".sidehead button", { hasText: "Scene" }).click();
    await tab.locator("#tab-render").click();
    await tab.locator('[data-param="maxdepth"] input.number').fill("2");
    await tab.locator('[data-param="maxdepth"] input.number').press("Tab");
    const less = rays.other!.trees[0]!.nodes.length;
    expect(less).not.toBe(all);
    await expect.poll(() => tab.locator(".tally").textContent()).toContain(`${less} rays`);
    expect(await tab.locator(".view canvas[data-selected]").getAttribute("data-selected")).toBe("2");
    expect(await tab.locator(".space").getAttribute("data-stage")).toBe(stage);
    expect(sent("ghost").length).toBe(1);
    calm();
  });

  it("is compared with another integrator, and its samples are gone through", async () => {
    await click();
    await tab.locator("#tab-compare").click();
    await tab.locator("#rival").selectOption("path");
    await expect.poll(() => tab.locator(".changes li").count()).toBeGreaterThan(3);
    expect(last("trace")).toMatchObject({ diff: { kind: "path", params: {} } });
    await tab.locator('.field[data-param="maxdepth"] input.number').fill("2");
    await tab.locator('.field[data-param="maxdepth"] input.number').press("Tab");
    await expect.poll(() => last("trace")).toMatchObject({ diff: { kind: "path", params: { maxdepth: 2 } } });
    await expect.poll(() => last("trace")!["samples"]).toBe(true);
    await tab.locator(".scrub input").press("ArrowRight");
    await expect.poll(() => tab.locator(".scrub output").textContent()).toBe("1");
    await tab.locator(".rayhead button", { hasText: "brightest" }).click();
    await expect.poll(() => last("trace")!["sample"]).toBe("brightest");
    calm();
  });

  it("follows the camera", async () => {
    await click();
    await expect.poll(() => last("trace")!["samples"]).toBe(true);
    const traces = sent("trace").length;
    await picture(tab).focus();
    await tab.keyboard.press("j");
    await expect.poll(() => sent("trace").length).toBeGreaterThan(traces);
    expect(await tab.locator("canvas[data-rays]").count()).toBe(1);
    calm();
  });
});

describe("what goes wrong", () => {
  it("comes back after a break, in the same session", async () => {
    await tab.keyboard.press("j");
    await expect.poll(() => sent("camera").length).toBe(1);
    const session = await tab.evaluate(() => window.durerLive!.main.link.session);
    mock.cut();
    await expect.poll(() => mock.viewers).toBe(1);
    await expect.poll(() => tab.evaluate(() => window.durerLive!.main.link.state.value.is)).toBe("open");
    expect(await tab.evaluate(() => window.durerLive!.main.link.session)).toBe(session);
    expect(await tab.locator(".tools button", { hasText: "Reset view" }).isEnabled()).toBe(true);
    await frames(tab, 3);
  });

  it("goes on with a new session if the old one is gone, and with the old one if the page is opened again", async () => {
    mock.forget();
    await expect.poll(() => tab.evaluate(() => window.durerLive!.main.link.state.value.is)).toBe("open");
    await expect.poll(() => mock.viewers).toBe(1);
    const session = await tab.evaluate(() => window.durerLive!.main.link.session);
    await tab.reload();
    await tab.waitForSelector(".picture canvas[data-samples]");
    expect(await tab.evaluate(() => window.durerLive!.main.link.session)).toBe(session);
  });

  it("says so while the program is away, and keeps the picture", async () => {
    const before = await pixelOf(tab, 0.5, 0.9);
    mock.stop();
    await tab.waitForSelector('[data-about="connection"]');
    expect(await tab.locator(".status").getAttribute("data-state")).toBe("offline");
    expect(await pixelOf(tab, 0.5, 0.9)).toEqual(before);
    // It does not hammer: after three seconds there were few tries.
    await tab.waitForTimeout(3000);
    expect(await tab.evaluate(() => window.durerLive!.main.link.state.value)).toMatchObject({ is: "lost" });
    expect(await tab.evaluate(() => (window.durerLive!.main.link.state.value as { tries: number }).tries)).toBeLessThan(8);
  });

  it("shows the error of a scene that cannot be read again, over the old picture, until it can", async () => {
    await expect.poll(() => picture(tab).getAttribute("data-done")).toBe("true");
    const shown = await pixelOf(tab, 0.49, 0.47);
    mock.fail("room.pbrt:3:1: <b>unknown</b> word");
    await tab.waitForSelector('[data-about="scene"]');
    expect(await tab.locator('[data-about="scene"] pre').textContent()).toBe("room.pbrt:3:1: <b>unknown</b> word");
    expect(await pixelOf(tab, 0.49, 0.47)).toEqual(shown);
    mock.fail(null);
    await tab.waitForSelector('[data-about="scene"]', { state: "detached" });
    mock.reload("balls, changed");
    await expect.poll(() => tab.locator("h1").textContent()).toBe("balls, changed");
    await expect.poll(() => picture(tab).getAttribute("data-revision")).toBe("2");
    calm();
  });

  it("tells why a file cannot be saved, and saves what can be", async () => {
    await tab.locator("button", { hasText: ".pbrt" }).click();
    await expect.poll(() => tab.locator(".wrong").textContent()).toBe("pbrt has no word for a mock");
    opened.complaints.length = 0;
    const [file] = await Promise.all([tab.waitForEvent("download"), tab.locator("button", { hasText: "PNG" }).click()]);
    expect(file.suggestedFilename()).toBe("mock.png");
    calm();
  });
});

describe.each([[390, 844], [820, 1180], [1280, 800], [1920, 1080]])("on %d x %d", (width, height) => {
  it("nothing sticks out, with and without rays", async () => {
    await tab.setViewportSize({ width, height });
    const fits = async (where: string): Promise<void> => {
      const wide = await tab.evaluate(() => [...document.querySelectorAll("header, main, aside, .status, .form, .sidehead, .body")]
        .filter((e) => e.getBoundingClientRect().right > innerWidth + 1 || e.scrollWidth > e.clientWidth + 1).map((e) => `${e.tagName}.${e.className}`));
      expect(wide, where).toEqual([]);
      expect(await tab.evaluate(() => document.documentElement.scrollHeight <= innerHeight), where).toBe(true);
    };
    for (const name of ["look", "render", "camera", "lights", "materials", "scene"]) {
      await tab.locator(`#tab-${name}`).click();
      if (name === "materials") await tab.locator(".folded summary").first().click();
      await fits(name);
    }
    await click();
    await fits("rays");
    calm();
  });
});
