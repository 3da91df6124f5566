// The state in the address: a link that opens the page as it is seen.
import { effect } from "@preact/signals";

import type { Theme } from "./looks";
import type { Store, Tab } from "./store";

const TABS: Tab[] = ["tree", "ray", "play", "samples", "numbers", "compare", "walk", "machine"];

/** Takes from an address what makes sense in this page. */
export function readHash(store: Store, hash: string): void {
  const words = new URLSearchParams(hash.replace(/^#/, ""));
  const whole = (key: string): number | null => {
    const text = words.get(key);
    return text !== null && /^\d{1,9}$/.test(text) ? Number(text) : null;
  };
  const sample = whole("sample");
  if (sample !== null) {
    const index = store.page.trees.findIndex((tree) => tree.sample === sample);
    if (index >= 0) store.chooseTree(index);
  }
  const tab = TABS.find((word) => word === words.get("view"));
  if (tab) store.tab.value = tab;
  const theme = words.get("theme");
  if (theme === "light" || theme === "dark") store.theme.value = theme as Theme;
  if (words.get("palette") === "safe") store.palette.value = "safe";
  if (words.get("tree") === "outline") store.treeStyle.value = "outline";
  if (words.get("march") === "breadth") store.march.value = "breadth";
  store.machine.value = tab === "machine";
  const step = whole("step");
  if (step !== null) store.go(step);
  const ray = whole("ray");
  if (ray !== null) store.select(ray);
}

/** The address for the state. */
export function hashOf(store: Store): string {
  const words = new URLSearchParams();
  if (store.treeIndex.value !== 0) words.set("sample", String(store.g.value.tree.sample));
  words.set("ray", String(store.selected.value));
  words.set("view", store.tab.value);
  if (store.theme.value !== "auto") words.set("theme", store.theme.value);
  if (store.palette.value !== "lecture") words.set("palette", store.palette.value);
  if (store.treeStyle.value !== "slide") words.set("tree", store.treeStyle.value);
  if (store.march.value !== "recursion") words.set("march", store.march.value);
  if (store.step.value !== null) words.set("step", String(store.step.value));
  return `#${words}`;
}

/** Keeps the address in step with the state. */
export function keepHash(store: Store): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let written = "";
  effect(() => {
    const next = hashOf(store);
    clearTimeout(timer);
    // Browsers refuse more than a few writes a second.
    timer = setTimeout(() => {
      written = next;
      try {
        history.replaceState(null, "", next);
      } catch {
        // Some viewers of local files allow no change; the page works without.
      }
    }, 300);
  });
  addEventListener("hashchange", () => {
    if (location.hash !== written) readHash(store, location.hash);
  });
}
