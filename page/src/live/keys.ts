// The keyboard of the live page: what moves the camera and the picture, unless the rays have the focus.
import { act, keeps, type Key } from "../state/keys";
import type { Viewer } from "../scene/viewer";
import { dolly, fly, orbit, pan } from "./camera";
import type { Hand, Live } from "./live";

export const PICTURE_HELP: { title: string; keys: Key[] }[] = [
  {
    title: "Camera",
    keys: [
      { keys: "W S Q Z", does: "fly: forward, back, up, down" },
      { keys: "J L I K", does: "turn around what is seen; with Shift shift it" },
      { keys: "+ −", does: "nearer, farther" },
      { keys: "R", does: "the scene’s own camera" },
      { keys: "O F M", does: "the mouse orbits, flies, magnifies" },
    ],
  },
  {
    title: "Picture",
    keys: [
      { keys: "← → ↑ ↓", does: "move the mark by a pixel, with Shift by ten" },
      { keys: "Enter", does: "the ray tree of the marked pixel" },
      { keys: "X", does: "what is at the marked pixel" },
      { keys: "1 … 8", does: "layers" },
      { keys: "V", does: "split view: on, off" },
      { keys: "< >", does: "smaller, larger; 0 fits" },
      { keys: "Space", does: "pause, continue" },
      { keys: "Esc", does: "close the ray tree" },
    ],
  },
];

const STEP = 0.12;
const HANDS: Record<string, Hand> = { o: "orbit", f: "fly", m: "zoom" };

/** Does what a key means for the picture; false if it means nothing. */
export function steer(live: Live, key: string, shift: boolean): boolean {
  const { main, looks } = live;
  if (key.startsWith("Arrow")) return mark(live, key, shift ? 10 : 1);
  const small = key.toLowerCase();
  const side = { j: [-1, 0], l: [1, 0], i: [0, -1], k: [0, 1] }[small] as [number, number] | undefined;
  if (side) {
    const [x, y] = side;
    live.moving((pose, world) => (shift ? pan(pose, world, -x * STEP, -y * STEP, live.opening()) : orbit(pose, world, -x * STEP, -y * STEP)));
    return true;
  }
  const flight = { w: [1, 0], s: [-1, 0], q: [0, 1], z: [0, -1] }[small] as [number, number] | undefined;
  if (flight) {
    live.moving((pose, world) => fly(pose, world, flight[0] * STEP, 0, flight[1] * STEP));
    return true;
  }
  if (/^[1-8]$/.test(key)) {
    const layer = main.layers.peek()[Number(key) - 1];
    if (layer) main.show(layer);
    return true;
  }
  const hand = HANDS[small];
  if (hand) {
    live.hand.value = hand;
    return true;
  }
  switch (small) {
    case "+": case "=": live.moving((pose, world) => dolly(pose, world, 1 / 1.14)); return true;
    case "-": live.moving((pose, world) => dolly(pose, world, 1.14)); return true;
    case "<": live.enlarge(1 / 1.5); return true;
    case ">": live.enlarge(1.5); return true;
    case "0": live.enlarge(null); return true;
    case "r": live.home(null); return true;
    case "v": if (live.against.peek()) live.unsplit(); else live.split(); return true;
    case " ": live.pause(!live.paused.peek()); return true;
    case "enter": live.choose(live.cursor.peek() ?? middle(live)); return true;
    case "x": live.choose(live.cursor.peek() ?? middle(live), true); return true;
    case "c": looks.palette.value = looks.palette.value === "safe" ? "lecture" : "safe"; return true;
    case "d": looks.theme.value = looks.dark.value ? "light" : "dark"; return true;
    case "?": looks.help.value = !looks.help.value; return true;
    default: return false;
  }
}

function middle(live: Live): [number, number] {
  const [w, h] = live.film.peek();
  return [w >> 1, h >> 1];
}

/** Moves the mark on the picture. */
function mark(live: Live, key: string, by: number): boolean {
  const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key] as [number, number] | undefined;
  if (!way) return false;
  const [x, y] = live.cursor.peek() ?? middle(live);
  const [w, h] = live.film.peek();
  const to: [number, number] = [Math.min(Math.max(x + way[0] * by, 0), w - 1), Math.min(Math.max(y + way[1] * by, 0), h - 1)];
  live.cursor.value = to;
  live.point(to);
  return true;
}

export function listen(live: Live, viewer: () => Viewer | null): void {
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { help } = live.looks;
    if (event.key === "Escape" && (help.value || live.rays.open.value)) {
      if (help.value) help.value = false;
      else live.closeRays();
      return;
    }
    if ((help.value && event.key !== "?") || keeps(event.target, event.key)) return;
    const store = live.rays.store.value;
    const onPicture = event.target instanceof Element && event.target.closest(".picture") !== null;
    const done = store && !onPicture ? act(store, viewer(), event.key) : steer(live, event.key, event.shiftKey);
    if (done) event.preventDefault();
  });
}
