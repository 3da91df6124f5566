// From the text inside the page to the document: base64, gzip, JSON.
import { BLACK } from "./color";
import type { Node, Page, Tree } from "./types";

/** Why there is nothing to show; the message is for people. */
export class NothingToShow extends Error {}

/** Bytes of base64 text; spaces and line ends are skipped. */
export function bytesOf(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text.replace(/\s+/g, ""));
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<string> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

/** Reads the document. */
export async function load(text: string): Promise<Page> {
  // By its form: the marker itself must stand only once in the built page, and a minifier joins what is cut in two.
  if (/^(__[A-Z_]+__)?$/.test(text.trim())) {
    throw new NothingToShow("This page holds no ray tree: durer trace SCENE --pixel X,Y -o tree.html writes one that does.");
  }
  let page: Page;
  try {
    page = JSON.parse(await inflate(bytesOf(text))) as Page;
  } catch (error) {
    throw new NothingToShow(`The ray tree in this page cannot be read: ${String(error)}`);
  }
  if (page.version !== 1) throw new NothingToShow(`The ray tree has version ${page.version}; this page reads version 1.`);
  if (!Array.isArray(page.trees) || !page.trees.some((tree) => tree.nodes.length > 0)) {
    throw new NothingToShow("There is no ray in this tree.");
  }
  return completed(page);
}

/** The compact form leaves out what does not apply; here it is null again. */
export function completed(page: Page): Page {
  const trees = page.trees.filter((tree) => tree.nodes.length > 0).map(tree);
  const other = page.other ? { ...page.other, trees: page.other.trees.filter((t) => t.nodes.length > 0).map(tree) } : null;
  const objects = (page.scene.objects ?? []).map((object) => ({ ...object, mesh: object.mesh ?? null }));
  return {
    ...page, trees, other, values: page.values ?? [], dims: page.dims ?? [], picture: page.picture ?? null,
    mean: page.mean ?? trees[0]!.rgb, scene: { ...page.scene, objects, lights: page.scene.lights ?? [] },
  };
}

function tree(found: Tree): Tree {
  return { ...found, nodes: found.nodes.map(node) };
}

const ABSENT = {
  parent: null, t: null, point: null, object: null, primitive: null, normal: null, uv: null, side: null, stop: null,
  light: null, blocker: null, local: BLACK, contribution: BLACK, result: BLACK, lost: BLACK,
};

function node(found: Node, id: number): Node {
  const light = found.light ? { ...found.light, name: found.light.name ?? null, point: found.light.point ?? null } : null;
  return { ...ABSENT, ...found, id, light };
}
