// Documents that the program wrote, as the page sees them after reading.
import { readFileSync } from "node:fs";
import { join } from "node:path";

import { completed } from "../../src/data/load";
import type { Page } from "../../src/data/types";

const FOLDER = join(__dirname, "../fixtures");

/** `durer trace whitted --pixel 370,200 --width 640 --height 360 --spp 2 --diff '--max-depth 2'
 * -o whitted.page.json`. */
export function whitted(): Page {
  return completed(JSON.parse(readFileSync(join(FOLDER, "whitted.json"), "utf8")) as Page);
}
