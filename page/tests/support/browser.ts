// Debian's Chromium without network, and a page opened from disk that tells of every request and complaint.
import { existsSync } from "node:fs";
import { pathToFileURL } from "node:url";

import { chromium, type Browser, type Page as Tab } from "playwright-core";

const PLACES = [process.env["DURER_CHROMIUM"] ?? "", "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

/** Where Chromium is, if it is there. */
export function chromiumPath(): string | null {
  return PLACES.find((path) => path !== "" && existsSync(path)) ?? null;
}

export async function launch(): Promise<Browser> {
  const executablePath = chromiumPath();
  if (!executablePath) throw new Error("no Chromium: apt-get install chromium, or name one in DURER_CHROMIUM");
  return chromium.launch({
    executablePath,
    args: [
      "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
    ],
  });
}

export interface Opened {
  tab: Tab;
  /** Addresses asked for beside the page itself. */
  requests: string[];
  /** Errors and warnings in the console, and exceptions. */
  complaints: string[];
}

export interface How { width?: number; height?: number; dark?: boolean; hash?: string; touch?: boolean }

/** Opens a file with the network cut. */
export async function open(browser: Browser, path: string, how: How = {}): Promise<Opened> {
  const context = await browser.newContext({
    viewport: { width: how.width ?? 1280, height: how.height ?? 800 },
    colorScheme: how.dark ? "dark" : "light",
    hasTouch: how.touch ?? false,
    reducedMotion: "reduce",
  });
  await context.setOffline(true);
  const tab = await context.newPage();
  const requests: string[] = [];
  const complaints: string[] = [];
  const address = pathToFileURL(path).href;
  await tab.route("**/*", (route) => {
    const url = route.request().url();
    if (url.split("#")[0] === address) return route.continue();
    requests.push(url);
    return route.abort();
  });
  tab.on("console", (message) => {
    const ours = !/GPU stall due to ReadPixels|GL Driver Message/.test(message.text());
    if (ours && (message.type() === "error" || message.type() === "warning")) complaints.push(message.text());
  });
  tab.on("pageerror", (error) => complaints.push(String(error)));
  await tab.goto(address + (how.hash ?? ""));
  await tab.waitForSelector("canvas[data-rays]", { timeout: 60_000 });
  return { tab, requests, complaints };
}
