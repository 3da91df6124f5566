// Screenshots at three sizes, light and dark, to be looked at: SHOTS=folder DOCUMENT=file.json npx vite-node ...
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import type { Page } from "../../src/data/types";
import { launch, open } from "./browser";
import { write } from "./fill";

const folder = process.env["SHOTS"] ?? "shots";
const document = JSON.parse(readFileSync(process.env["DOCUMENT"] ?? "", "utf8")) as Page;
const only = process.env["ONLY"];
const hashes = (process.env["HASH"] ?? "").split(",");
mkdirSync(folder, { recursive: true });
const browser = await launch();
const path = write(document, "shot");
const sizes: [number, number, boolean][] = [[390, 844, false], [390, 844, true], [1280, 800, false], [1280, 800, true], [1920, 1080, false], [1920, 1080, true]];
for (const [width, height, dark] of sizes) {
  const name = `${width}-${dark ? "dark" : "light"}`;
  if (only && !name.match(only)) continue;
  for (const hash of hashes) {
    const { tab, complaints } = await open(browser, path, { width, height, dark, hash: hash ? `#${hash}` : "" });
    await tab.waitForTimeout(900);
    await tab.screenshot({ path: join(folder, `${name}${hash ? `-${hash.replace(/[^a-z0-9]+/g, "_")}` : ""}.png`) });
    if (complaints.length > 0) console.error(name, hash, complaints);
    await tab.context().close();
  }
}
await browser.close();
