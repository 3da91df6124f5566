// What of the traced rays is not in this page, in words.
import { luminance } from "./color";
import { count, percent } from "./number";
import type { LeftOut, Page, Tree } from "./types";

/** The part of a sample's light that rays add. */
function part(missing: LeftOut, tree: Tree): string {
  const [own, all] = [luminance(missing.contribution), luminance(tree.rgb)];
  if (!Number.isFinite(own / all)) return "";
  return own === 0 ? ", which add nothing to the pixel" : `, ${percent(own / all)} of the sample’s light`;
}

/** Below a ray. */
export function belowRay(missing: LeftOut, tree: Tree): string {
  return `${count(missing.rays)} ${missing.rays === 1 ? "ray" : "rays"} below left out of this page${part(missing, tree)}`;
}

/** Of a tree. */
export function ofTree(tree: Tree): string | null {
  if (!tree.left_out) return null;
  const whole = tree.nodes.length + tree.left_out.rays;
  return `${count(tree.left_out.rays)} of ${count(whole)} rays are left out of this page${part(tree.left_out, tree)}.`;
}

/** Of the page: sentences, and how to get all. */
export function ofPage(page: Page, tree: Tree): string[] {
  const said = ofTree(tree);
  const words = page.left_out ?? [];
  const all = [...(said ? [`${said} Those that add most are here, with all above them.`] : []),
    ...(words.length > 0 ? [`Also left out: ${words.join("; ")}.`] : [])];
  return all.length > 0 ? [...all, "All is in the JSON: durer trace with the same options and -o tree.json."] : [];
}
