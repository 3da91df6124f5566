// Puts a document into the built page as the program does: gzip, base64, at the marker.
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { gzipSync } from "node:zlib";

import type { Page } from "../../src/data/types";

const BUILT = join(import.meta.dirname ?? __dirname, "../../dist/index.html");

/** The built page's text. */
export function built(): string {
  if (!existsSync(BUILT)) throw new Error("page/dist/index.html is missing: npm run build");
  return readFileSync(BUILT, "utf8");
}

export function filled(document: Page): string {
  const data = gzipSync(Buffer.from(JSON.stringify(document)), { level: 9 }).toString("base64");
  return built().replace("__DURER_DATA__", () => data);
}

/** Writes the page where a browser can open it; says where. */
export function write(document: Page, name: string): string {
  const path = join(mkdtempSync(join(tmpdir(), "durer-page-")), `${name}.html`);
  writeFileSync(path, filled(document));
  return path;
}
