// The keyboard: one table for what keys do and for the page that explains them.
import type { Viewer } from "../scene/viewer";
import type { Store, Tab } from "./store";

export interface Key { keys: string; does: string }

export const HELP: { title: string; keys: Key[] }[] = [
  {
    title: "Rays",
    keys: [
      { keys: "↑ ↓", does: "previous, next ray" },
      { keys: "← →", does: "to the parent or fold; open or to the first child" },
      { keys: "Home End", does: "first, last ray" },
      { keys: "Enter", does: "look at the ray’s hit" },
    ],
  },
  {
    title: "Playback",
    keys: [
      { keys: "Space", does: "play, pause" },
      { keys: ", .", does: "step back, step forward" },
      { keys: "0", does: "all rays again" },
    ],
  },
  {
    title: "View",
    keys: [
      { keys: "E", does: "through the eye of the picture" },
      { keys: "A", does: "all of the scene" },
      { keys: "P", does: "the plane of incidence, seen from the side" },
      { keys: "G", does: "sit on the ray; G again gets off" },
      { keys: "W S Q Z", does: "fly: forward, back, up, down" },
      { keys: "J L I K", does: "turn around the scene" },
      { keys: "+ −", does: "nearer, farther" },
    ],
  },
  {
    title: "Page",
    keys: [
      { keys: "1 … 8", does: "tree, ray, play, samples, numbers, compare, walk, machine" },
      { keys: "[ ]", does: "previous, next sample" },
      { keys: "B", does: "all samples as a bundle" },
      { keys: "C", does: "colours of the lecture, or for the colour-blind" },
      { keys: "D", does: "light, dark" },
      { keys: "?", does: "this help" },
    ],
  },
];

const TABS: Tab[] = ["tree", "ray", "play", "samples", "numbers", "compare", "walk", "machine"];

/** Moves the selection in the order of the outline. */
export function moveSelection(store: Store, key: string): boolean {
  const rows = store.shownRows.value;
  const at = rows.indexOf(store.selected.value);
  const id = store.selected.value;
  const g = store.g.value;
  switch (key) {
    case "ArrowDown": store.select(rows[Math.min(at + 1, rows.length - 1)]!); return true;
    case "ArrowUp": store.select(rows[Math.max(at - 1, 0)]!); return true;
    case "Home": store.select(rows[0]!); return true;
    case "End": store.select(rows[rows.length - 1]!); return true;
    case "ArrowRight":
      if (store.folded.value.has(id)) store.fold(id, false);
      else if (g.children[id]!.length > 0) store.select(rows[at + 1]!);
      return true;
    case "ArrowLeft":
      if (g.children[id]!.length > 0 && !store.folded.value.has(id) && id !== 0) store.fold(id, true);
      else if (g.nodes[id]!.parent !== null) store.select(g.nodes[id]!.parent!);
      return true;
    default: return false;
  }
}

/** True where a key has a meaning of its own: all keys in fields, those that move and choose in tabs and sliders. */
export function keeps(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.matches("select, textarea, input:not([type=range]):not([type=checkbox])")) return true;
  if ((key === "Enter" || key === " ") && target.matches("input, button, a, summary")) return true;
  return /^(Arrow|Home|End|Page)/.test(key) && target.matches("input, [role=tab], [data-keys]");
}

export function listen(store: Store, viewer: () => Viewer | null): void {
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Escape" && store.help.value) {
      store.help.value = false;
      return;
    }
    if (store.help.value && event.key !== "?") return;
    if (keeps(event.target, event.key)) return;
    if (act(store, viewer(), event.key)) event.preventDefault();
  });
}

/** Does what a key means for the rays; false if it means nothing. */
export function act(store: Store, viewer: Viewer | null, key: string): boolean {
  if (moveSelection(store, key)) return true;
  const at = store.step.value;
  switch (key) {
    case " ": store.playing.value = !store.playing.value; return true;
    case ".": store.playing.value = false; store.go(at === null ? 0 : at + 1); return true;
    case ",": store.playing.value = false; store.go(at === null ? store.plot.value.steps.length - 1 : at - 1); return true;
    case "0": store.go(null); return true;
    case "[": store.chooseTree(store.treeIndex.value - 1); return true;
    case "]": store.chooseTree(store.treeIndex.value + 1); return true;
    case "?": store.help.value = !store.help.value; return true;
    default: break;
  }
  if (/^[1-8]$/.test(key)) {
    openTab(store, TABS[Number(key) - 1]!);
    return true;
  }
  switch (key.toLowerCase()) {
    case "b": store.bundle.value = !store.bundle.value; return true;
    case "c": store.palette.value = store.palette.value === "safe" ? "lecture" : "safe"; return true;
    case "d": store.theme.value = store.dark.value ? "light" : "dark"; return true;
    case "enter": viewer?.look("hit"); return true;
    case "e": viewer?.look("eye"); return true;
    case "a": viewer?.look("all"); return true;
    case "p": viewer?.look("plane"); return true;
    case "g": store.sitting.value = !store.sitting.value; return true;
    default: return viewer?.key(key.toLowerCase()) ?? false;
  }
}

/** Opens a tab; the machine is part of the scene as long as its tab is open. */
export function openTab(store: Store, tab: Tab): void {
  if (tab === "compare" && !store.page.other) return;
  store.tab.value = tab;
  store.machine.value = tab === "machine";
}
