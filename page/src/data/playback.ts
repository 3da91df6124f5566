// The recursion as steps: a ray is sent (push), its hit is shaded, its result goes back to its parent (pop).
import { add, BLACK, times } from "./color";
import type { Grove } from "./forest";
import { asksLight, isUntraced } from "./kinds";
import type { Rgb } from "./types";

export type Act = "push" | "shade" | "pop";
export interface Step { act: Act; node: number }

/** Depth first, as the program does it, or all rays of a level before the next. */
export type March = "recursion" | "breadth";

export interface Script {
  steps: Step[];
  /** Index of the step that sends each ray. */
  pushed: number[];
  /** Index of the step after which each ray's result is known. */
  popped: number[];
}

export function script(g: Grove, march: March): Script {
  const steps = march === "recursion" ? recursion(g) : breadth(g);
  const pushed = g.nodes.map(() => -1);
  const popped = g.nodes.map(() => steps.length);
  steps.forEach((step, index) => {
    if (step.act === "push") pushed[step.node] = index;
    if (step.act === "pop") popped[step.node] = index;
  });
  return { steps, pushed, popped };
}

function shades(g: Grove, id: number): boolean {
  const node = g.nodes[id]!;
  return !asksLight(node) && !isUntraced(node) && (node.point !== null || g.children[id]!.length > 0);
}

function recursion(g: Grove): Step[] {
  const steps: Step[] = [];
  const open: Step[] = [];
  const roots = g.nodes.flatMap((node, id) => (node.parent === null ? [id] : []));
  for (const id of roots.reverse()) open.push({ act: "push", node: id });
  while (open.length > 0) {
    const step = open.pop()!;
    steps.push(step);
    if (step.act !== "push") continue;
    const id = step.node;
    open.push({ act: "pop", node: id });
    const below = g.children[id]!;
    for (let i = below.length - 1; i >= 0; i--) open.push({ act: "push", node: below[i]! });
    if (shades(g, id)) open.push({ act: "shade", node: id });
  }
  return steps;
}

function breadth(g: Grove): Step[] {
  const steps: Step[] = [];
  let level = g.nodes.flatMap((node, id) => (node.parent === null ? [id] : []));
  const levels: number[][] = [];
  while (level.length > 0) {
    levels.push(level);
    for (const node of level) {
      steps.push({ act: "push", node });
      if (shades(g, node)) steps.push({ act: "shade", node });
    }
    level = level.flatMap((id) => g.children[id]!);
  }
  for (const ids of levels.reverse()) ids.forEach((node) => steps.push({ act: "pop", node }));
  return steps;
}

export interface Frame {
  node: number;
  /** What the ray has summed so far. */
  sum: Rgb;
  shaded: boolean;
}

/** The calls that are open after a step, outermost first, each with its sum so far. */
export function stack(g: Grove, s: Script, at: number): Frame[] {
  const step = s.steps[at];
  if (!step) return [];
  const ids: number[] = [];
  for (let id: number | null = step.node; id !== null; id = g.nodes[id]!.parent) ids.push(id);
  ids.reverse();
  return ids.map((id) => {
    const last = id === step.node;
    const shaded = !last || step.act !== "push";
    return { node: id, sum: shaded ? summed(g, s, id, at) : BLACK, shaded };
  });
}

function summed(g: Grove, s: Script, id: number, at: number): Rgb {
  const { local, left_out } = g.nodes[id]!;
  let sum = left_out ? add(local, left_out.result) : local;
  for (const child of g.children[id]!) {
    if (s.popped[child]! > at) continue;
    sum = add(sum, times(g.nodes[child]!.weight, g.nodes[child]!.result));
  }
  return sum;
}
