// How the slide's tree is drawn: edges in the colours of the rays with L, R and T, hits as circles with N.
import { STEP_Y, type Layout } from "../data/layout";
import { asksLight, cssOf, isUntraced, lookOf, stopOf } from "../data/kinds";
import { subscript } from "../data/number";
import type { Store } from "../state/store";

/** Places are scaled, signs and letters keep their size. */
export interface View { x: number; y: number; sx: number; sy: number }

const DASHES: number[][] = [[], [5, 3.5], [1.5, 3], [9, 3], [6, 3, 1.5, 3]];
const SERIF = "italic 15px 'Iowan Old Style', Palatino, 'Palatino Linotype', 'P052', Georgia, serif";

interface Ink { text: string; quiet: string; paper: string; accent: string; casing: string }

export function draw(c: CanvasRenderingContext2D, size: [number, number], view: View, tree: Layout, store: Store): void {
  const dark = store.dark.value;
  const ink: Ink = dark
    ? { text: "#ece9e2", quiet: "#8f939b", paper: "#1b1e23", accent: "#ffd659", casing: "rgb(255 255 255 / .34)" }
    : { text: "#1f1d1a", quiet: "#837d72", paper: "#fbfaf6", accent: "#ffb81f", casing: "rgb(0 0 0 / .38)" };
  c.clearRect(0, 0, ...size);
  const words = view.sx > 0.42;
  const near = 60;
  const onScreen = (id: number): [number, number] => {
    const { x, y } = tree.placed[tree.at[id]!]!;
    return [x * view.sx + view.x, y * view.sy + view.y];
  };
  const level = (y: number): boolean => y * view.sy + view.y > -near && (y - STEP_Y) * view.sy + view.y < size[1] + near;
  const inSight = tree.placed.filter((p) => level(p.y));
  const pen: Pen = { c, ink, store, words, crowded: view.sx < 0.8, onScreen };
  for (const { id } of inSight) edge(pen, id, size[0]);
  for (const { id } of inSight) {
    const [x, y] = onScreen(id);
    if (x > -near && x < size[0] + near) end(pen, id, x, y);
  }
}

interface Pen {
  c: CanvasRenderingContext2D;
  ink: Ink;
  store: Store;
  words: boolean;
  crowded: boolean;
  onScreen: (id: number) => [number, number];
}

/** How visible a ray is: the playback has not sent those that come later. */
function presence(store: Store, id: number): number {
  const step = store.step.value;
  if (step !== null && store.plot.value.pushed[id]! > step) return 0.13;
  return 1;
}

function edge({ c, ink, store, words, crowded, onScreen }: Pen, id: number, screen: number): void {
  const g = store.g.value;
  const node = g.nodes[id]!;
  const [x1, y1] = onScreen(id);
  const from = node.parent !== null;
  const [x0, y0] = from ? onScreen(node.parent!) : [x1, y1 - 38];
  if (Math.max(x0, x1) < -20 || Math.min(x0, x1) > screen + 20) return;
  const look = lookOf(node.kind);
  const width = 1.4 + 2.6 * Math.sqrt(Math.min(1, Math.max(0, ...node.throughput)));
  c.globalAlpha = presence(store, id) * (isUntraced(node) ? 0.55 : 1);
  c.lineCap = "butt";
  const path = (): void => {
    c.beginPath();
    c.moveTo(x0, y0);
    c.lineTo(x1, y1);
  };
  const chosen = store.selected.value === id || store.hovered.value === id;
  if (chosen) {
    c.setLineDash([]);
    c.strokeStyle = ink.accent;
    c.lineWidth = width + 7;
    path();
    c.stroke();
  }
  c.setLineDash(isUntraced(node) ? [2, 4] : DASHES[look.dash]!);
  c.strokeStyle = ink.casing;
  c.lineWidth = width + 1.4;
  path();
  c.stroke();
  c.strokeStyle = cssOf(node.kind, store.palette.value);
  c.lineWidth = width;
  path();
  c.stroke();
  c.setLineDash([]);
  if (!words) return;
  // Letters near the lower end, where edges are apart.
  const t = from ? 0.58 : 0.4;
  const [mx, my] = [x0 + (x1 - x0) * t, y0 + (y1 - y0) * t];
  // Where leaves are crowded the letter must do.
  const brief = crowded && g.children[id]!.length === 0;
  const name = !from ? "eye" : brief ? look.letter : g.letters[id]!;
  c.font = SERIF;
  c.textAlign = "center";
  c.textBaseline = "middle";
  const half = c.measureText(name).width / 2 + 2;
  c.fillStyle = ink.paper;
  c.globalAlpha *= 0.85;
  c.fillRect(mx - half, my - 8, 2 * half, 16);
  c.globalAlpha = presence(store, id) * (isUntraced(node) ? 0.7 : 1);
  c.fillStyle = chosen || store.path.value.has(id) ? ink.text : ink.quiet;
  c.fillText(name, mx, my);
}

function end(pen: Pen, id: number, x: number, y: number): void {
  const { c, ink, store, words } = pen;
  const g = store.g.value;
  const node = g.nodes[id]!;
  const part = g.most > 0 ? Math.abs(g.shares[id]!) / g.most : 0;
  const r = words ? 6 + 9 * Math.sqrt(part) : 2 + 4 * Math.sqrt(part);
  c.globalAlpha = presence(store, id);
  const hit = node.point !== null && !asksLight(node);
  if (store.selected.value === id) {
    c.fillStyle = ink.accent;
    c.beginPath();
    c.arc(x, y, (hit ? r : words ? 9 : 3) + 4, 0, 2 * Math.PI);
    c.fill();
  }
  c.fillStyle = ink.paper;
  c.strokeStyle = hit ? ink.text : ink.quiet;
  c.lineWidth = hit ? 1.4 : 1;
  c.beginPath();
  c.arc(x, y, hit ? r : words ? 8 : 1.5, 0, 2 * Math.PI);
  c.fill();
  if (hit) c.stroke();
  c.textAlign = "center";
  c.textBaseline = "middle";
  if (hit) {
    c.globalAlpha *= 0.3;
    c.fillStyle = cssOf(node.kind, store.palette.value);
    c.beginPath();
    c.arc(x, y, r - 1, 0, 2 * Math.PI);
    c.fill();
    c.globalAlpha = presence(store, id);
  }
  if (words) glyph(pen, id, x, y, r, hit);
  if (words && node.left_out) {
    // A branch that is cut off: a stump with the number of its rays.
    c.strokeStyle = ink.quiet;
    c.setLineDash([2, 2]);
    c.beginPath();
    c.moveTo(x + r * 0.7, y + r * 0.7);
    c.lineTo(x + r * 0.7 + 9, y + r * 0.7 + 9);
    c.stroke();
    c.setLineDash([]);
    c.fillStyle = ink.quiet;
    c.font = "11px system-ui, sans-serif";
    c.textAlign = "left";
    c.fillText(`… ${node.left_out.rays}`, x + r * 0.7 + 10, y + r * 0.7 + 12);
    c.textAlign = "center";
  }
  if (store.folded.value.has(id) && words) {
    c.fillStyle = ink.quiet;
    c.font = "11px system-ui, sans-serif";
    c.fillText(`+${g.sizes[id]! - 1}`, x, y + r + 9);
  }
  c.globalAlpha = 1;
}

function glyph({ c, ink, store }: Pen, id: number, x: number, y: number, r: number, hit: boolean): void {
  const g = store.g.value;
  const node = g.nodes[id]!;
  c.fillStyle = ink.text;
  if (hit) {
    c.font = SERIF.replace("15px", `${r > 11 ? 14 : 12}px`);
    const name = `N${subscript(g.hits[id]!)}`;
    if (r >= 10) c.fillText(name, x, y + 0.5);
    else {
      c.textAlign = "left";
      c.fillText(name, x + r + 2, y - 7);
      c.textAlign = "center";
    }
    if (node.stop) {
      c.font = "11px system-ui, sans-serif";
      c.fillStyle = ink.quiet;
      if (!store.folded.value.has(id)) c.fillText(stopOf(node.stop).sign, x, y + r + 9);
    }
    return;
  }
  c.font = "13px system-ui, 'DejaVu Sans', sans-serif";
  c.fillText(node.stop ? stopOf(node.stop).sign : "·", x, y + 0.5);
}
