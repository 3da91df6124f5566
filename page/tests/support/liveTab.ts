// The live page in a browser: opened at an address, with what it asks of others and what it complains of.
import type { Browser, Locator, Page as Tab } from "playwright-core";

export interface OpenedLive {
  tab: Tab;
  /** Addresses of other servers that it asked for. */
  strangers: string[];
  complaints: string[];
}

export async function openLive(browser: Browser, address: string, how: { width?: number; height?: number; dark?: boolean } = {}): Promise<OpenedLive> {
  const context = await browser.newContext({ viewport: { width: how.width ?? 1280, height: how.height ?? 800 }, colorScheme: how.dark ? "dark" : "light", reducedMotion: "reduce" });
  const tab = await context.newPage();
  const [strangers, complaints]: [string[], string[]] = [[], []];
  const own = new URL(address).host;
  tab.on("request", (request) => {
    const url = new URL(request.url());
    if (url.host !== own && !/^(data|blob):/.test(url.protocol)) strangers.push(request.url());
  });
  tab.on("console", (message) => {
    const ours = !/GPU stall due to ReadPixels|GL Driver Message|willReadFrequently/.test(message.text());
    if (ours && (message.type() === "error" || message.type() === "warning")) complaints.push(message.text());
  });
  tab.on("pageerror", (error) => complaints.push(String(error)));
  await tab.goto(address);
  await tab.waitForSelector(".picture canvas[data-samples]", { timeout: 60_000 });
  return { tab, strangers, complaints };
}

export function picture(tab: Tab): Locator {
  return tab.locator(".picture canvas");
}

/** Waits until so many frames more were drawn. */
export async function frames(tab: Tab, more: number): Promise<void> {
  const count = async (): Promise<number> => Number(await picture(tab).getAttribute("data-frames"));
  const goal = (await count()) + more;
  const until = Date.now() + 30_000;
  while ((await count()) < goal) {
    if (Date.now() > until) throw new Error("no more frames come");
    await tab.waitForTimeout(20);
  }
}

/** What the canvas shows at shares of its width and height: red, green, blue, opacity. Not where pixels of the film meet: there
 * browsers may take either. */
export function pixelOf(tab: Tab, u: number, v: number): Promise<number[]> {
  return picture(tab).evaluate((canvas: HTMLCanvasElement, [x, y]) =>
    [...canvas.getContext("2d")!.getImageData(Math.floor(canvas.width * x!), Math.floor(canvas.height * y!), 1, 1).data], [u, v]);
}
