// What is shown and chosen: one store that all views read and write.
import { batch, computed, effect, signal } from "@preact/signals";

import { compare, type Pair } from "../data/compare";
import { firstFolds, grove, pathTo, rows, type Grove, type Order } from "../data/forest";
import { script, type March } from "../data/playback";
import type { Page } from "../data/types";
import { createLooks } from "./looks";

export type Tab = "tree" | "ray" | "play" | "samples" | "numbers" | "compare" | "walk" | "machine";
export type TreeStyle = "slide" | "outline";

/** Rows that a tree may open with; more is folded. */
const MOST_ROWS = 400;

export function createStore(first: Page, looks = createLooks()) {
  const shown = signal(first);
  // Read with each page: what follows from trees is found once for each.
  const groves = computed(() => shown.value.trees.map((): Grove | undefined => undefined));
  const others = computed(() => (shown.value.other?.trees ?? []).map((): Grove | undefined => undefined));
  const groveOf = (index: number): Grove => (groves.value[index] ??= grove(shown.value.trees[index]!));
  const otherOf = (index: number): Grove => (others.value[index] ??= grove(shown.value.other!.trees[index]!));

  const treeIndex = signal(0);
  const selected = signal(0);
  const hovered = signal<number | null>(null);
  const folded = signal<ReadonlySet<number>>(firstFolds(groveOf(0), MOST_ROWS));
  const order = signal<Order>("recorded");
  const treeStyle = signal<TreeStyle>("slide");
  const tab = signal<Tab>("ray");
  const march = signal<March>("recursion");
  /** Step of the playback; null shows all rays. */
  const step = signal<number | null>(null);
  const playing = signal(false);
  const speed = signal(2);
  const loop = signal(false);
  const bundle = signal(false);
  const machine = signal(false);
  /** Film position that the machine's string goes through; null is that of the sample. */
  const machineAt = signal<[number, number] | null>(null);
  const sitting = signal(false);
  const walkStep = signal<number | null>(null);

  /** Asks for a sample whose rays are not in this page, where there is somebody to ask. */
  const ask = signal<((sample: number) => void) | null>(null);

  const g = computed(() => groveOf(treeIndex.value));
  const node = computed(() => g.value.nodes[selected.value] ?? g.value.nodes[0]!);
  const path = computed(() => new Set(pathTo(g.value, node.value.id)));
  const shownRows = computed(() => rows(g.value, folded.value, order.value));
  const plot = computed(() => script(g.value, march.value));
  const rival = computed<Grove | null>(() => {
    const { other } = shown.value;
    if (!other || other.trees.length === 0) return null;
    const sample = g.value.tree.sample;
    const same = other.trees.findIndex((tree) => tree.sample === sample);
    return same < 0 ? (treeIndex.value === 0 ? otherOf(0) : null) : otherOf(same);
  });
  const pairs = computed<Pair[]>(() => (rival.value ? compare(g.value, rival.value, g.value.tree.diff) : []));

  function chooseTree(index: number): void {
    if (!shown.peek().trees[index] || index === treeIndex.peek()) return;
    batch(() => {
      treeIndex.value = index;
      selected.value = 0;
      hovered.value = null;
      step.value = null;
      playing.value = false;
      walkStep.value = null;
      folded.value = firstFolds(groveOf(index), MOST_ROWS);
    });
  }

  /** Shows another page of the same scene; the sample and the ray stay chosen where they are there again. */
  function replace(next: Page, sample = g.peek().tree.sample): void {
    const was = node.peek();
    batch(() => {
      shown.value = next;
      treeIndex.value = Math.max(next.trees.findIndex((tree) => tree.sample === sample), 0);
      const same = next.trees[treeIndex.peek()]!.nodes[was.id];
      selected.value = same && same.kind === was.kind && same.parent === was.parent ? was.id : 0;
      hovered.value = null;
      step.value = null;
      playing.value = false;
      walkStep.value = null;
      machineAt.value = null;
      folded.value = firstFolds(groveOf(treeIndex.peek()), MOST_ROWS);
      if (!next.other && tab.peek() === "compare") tab.value = "ray";
    });
  }

  /** Selects a ray and opens what it is folded into. */
  function select(id: number): void {
    const here = g.peek();
    if (!here.nodes[id]) return;
    batch(() => {
      if (id !== selected.peek()) walkStep.value = null;
      selected.value = id;
      const above = pathTo(here, id).slice(0, -1);
      if (above.some((other) => folded.peek().has(other))) {
        const next = new Set(folded.peek());
        above.forEach((other) => next.delete(other));
        folded.value = next;
      }
    });
  }

  function fold(id: number, closed: boolean): void {
    if (folded.peek().has(id) === closed || g.peek().children[id]?.length === 0) return;
    const next = new Set(folded.peek());
    if (closed) next.add(id);
    else next.delete(id);
    folded.value = next;
  }

  function foldAll(closed: boolean): void {
    const here = g.peek();
    folded.value = closed ? new Set(here.children.flatMap((below, id) => (below.length && id ? [id] : []))) : new Set();
  }

  /** Goes to a step of the playback; the ray of the step is selected. */
  function go(to: number | null): void {
    const last = plot.peek().steps.length - 1;
    batch(() => {
      if (to === null) {
        step.value = null;
        playing.value = false;
        return;
      }
      step.value = Math.min(Math.max(to, 0), last);
      select(plot.peek().steps[step.value]!.node);
    });
  }

  return {
    get page(): Page {
      return shown.value;
    },
    ...looks, looks, groveOf, treeIndex, selected, hovered, folded, order, treeStyle, tab, march, step, playing, speed, loop,
    bundle, machine, machineAt, sitting, walkStep, g, node, path, shownRows, plot, rival, pairs, ask,
    chooseTree, replace, select, fold, foldAll, go,
  };
}

export type Store = ReturnType<typeof createStore>;

/** Moves the playback on while it plays, until what it returns is called. */
export function runPlayback(store: Store): () => void {
  return effect(() => {
    if (!store.playing.value) return undefined;
    const at = store.step.value;
    const last = store.plot.value.steps.length - 1;
    const wait = 1000 / store.speed.value;
    const timer = setTimeout(() => {
      if (at === null) store.go(0);
      else if (at < last) store.go(at + Math.max(1, Math.round(store.speed.peek() / 30)));
      else if (store.loop.peek()) store.go(0);
      else store.playing.value = false;
    }, Math.max(wait, 33));
    return () => clearTimeout(timer);
  });
}
