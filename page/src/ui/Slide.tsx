// The tree as on the lecture's slide, on a canvas: it is shifted and scaled, and thousands of rays are no burden.
import { effect } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { layout, type Layout } from "../data/layout";
import type { Tree } from "../data/types";
import type { Store } from "../state/store";
import { draw, type View } from "./drawSlide";

export function Slide({ store }: { store: Store }): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const painter = new Painter(canvas.current!, store);
    return () => painter.stop();
  }, []);
  const g = store.g.value;
  const node = store.node.value;
  return (
    <canvas class="slide" ref={canvas} tabIndex={0} role="application"
      aria-label={`Ray tree of ${g.nodes.length} rays. Chosen: ${g.letters[node.id]}, ${node.object ?? node.light?.name ?? node.stop ?? ""}. Arrow keys move.`} />
  );
}

class Painter {
  private readonly view: View = { x: 0, y: 0, sx: 1, sy: 1 };
  private placed: Layout = { placed: [], at: new Int32Array(0), width: 0, height: 0 };
  private waiting = false;
  private fitted = "";
  private fittedTree: Tree | null = null;
  private readonly endings: (() => void)[] = [];

  constructor(private readonly canvas: HTMLCanvasElement, private readonly store: Store) {
    const observer = new ResizeObserver(() => {
      this.fit(false);
      this.invalidate();
    });
    observer.observe(canvas);
    this.endings.push(() => observer.disconnect());
    this.endings.push(effect(() => {
      this.placed = layout(store.g.value, store.folded.value, store.order.value);
      this.fit(true);
      this.invalidate();
    }));
    this.endings.push(effect(() => {
      store.hovered.value;
      store.dark.value;
      store.palette.value;
      store.step.value;
      this.reveal(store.selected.value);
      this.invalidate();
    }));
    this.hands();
  }

  stop(): void {
    this.endings.forEach((end) => end());
  }

  /** Shows all of a small tree, the middle of a large one. */
  private fit(always: boolean): void {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const [key, { tree }] = [`${w} ${h}`, this.store.g.peek()];
    const first = key !== this.fitted || tree !== this.fittedTree;
    if (w === 0 || !(first || always)) return;
    [this.fitted, this.fittedTree] = [key, tree];
    if (first) {
      const { view, placed } = this;
      view.sx = Math.min(Math.max((w - 60) / Math.max(placed.width, 1), 0.6), 1.6);
      view.sy = Math.min(Math.max((h - 100) / Math.max(placed.height, 1), 0.62), 1.15);
      view.x = w / 2 - (placed.width / 2) * view.sx;
      view.y = Math.max(52, Math.min((h - placed.height * view.sy) / 2, 76));
    }
    this.reveal(this.store.selected.peek());
  }

  /** Shifts the tree so that a ray is in sight. */
  private reveal(id: number): void {
    const at = this.placed.placed[this.placed.at[id] ?? -1];
    const { clientWidth: w, clientHeight: h } = this.canvas;
    if (!at || w === 0) return;
    const [x, y] = [at.x * this.view.sx + this.view.x, at.y * this.view.sy + this.view.y];
    const margin = Math.min(48, w / 4);
    if (x < margin) this.view.x += margin - x;
    if (x > w - margin) this.view.x -= x - (w - margin);
    if (y < margin * 0.7) this.view.y += margin * 0.7 - y;
    if (y > h - margin) this.view.y -= y - (h - margin);
  }

  private invalidate(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      const { clientWidth: w, clientHeight: h } = this.canvas;
      if (w === 0) return;
      const ratio = Math.min(devicePixelRatio, 2);
      [this.canvas.width, this.canvas.height] = [Math.round(w * ratio), Math.round(h * ratio)];
      const context = this.canvas.getContext("2d")!;
      context.scale(ratio, ratio);
      draw(context, [w, h], this.view, this.placed, this.store);
      this.canvas.dataset["shown"] = String(this.placed.placed.length);
    });
  }

  /** The ray whose place is nearest to a point of the screen. */
  private under(x: number, y: number): number | null {
    const { view, placed } = this;
    let best: number | null = null;
    let least = 24 ** 2;
    for (const place of placed.placed) {
      const dy = place.y * view.sy + view.y - y;
      if (Math.abs(dy) > 24) continue;
      const d = (place.x * view.sx + view.x - x) ** 2 + dy ** 2;
      if (d < least) [least, best] = [d, place.id];
    }
    return best;
  }

  private hands(): void {
    const { canvas, store, view } = this;
    const fingers = new Map<number, [number, number]>();
    let travelled = 0;
    const local = (event: PointerEvent | WheelEvent | MouseEvent): [number, number] => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    const zoom = ([x, y]: [number, number], factor: number): void => {
      const by = Math.min(Math.max(view.sx * factor, 0.01), 4) / view.sx;
      view.x = x - (x - view.x) * by;
      view.y = y - (y - view.y) * by;
      view.sx *= by;
      view.sy *= by;
      this.invalidate();
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (fingers.size === 0) travelled = 0;
      fingers.set(event.pointerId, local(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      const at = local(event);
      const before = fingers.get(event.pointerId);
      if (!before) {
        store.hovered.value = this.under(...at);
        return;
      }
      travelled += Math.hypot(at[0] - before[0], at[1] - before[1]);
      if (fingers.size === 2) {
        const other = [...fingers].find(([id]) => id !== event.pointerId)![1];
        const [was, is] = [before, at].map((p) => Math.hypot(p[0] - other[0], p[1] - other[1])) as [number, number];
        zoom([(at[0] + other[0]) / 2, (at[1] + other[1]) / 2], is / Math.max(was, 1));
      } else if (travelled > 4) {
        view.x += at[0] - before[0];
        view.y += at[1] - before[1];
        this.invalidate();
      }
      fingers.set(event.pointerId, at);
    });
    const up = (event: PointerEvent): void => {
      const tapped = fingers.delete(event.pointerId) && travelled <= 4 && event.type === "pointerup";
      const found = tapped ? this.under(...local(event)) : null;
      if (found !== null) store.select(found);
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("pointerleave", () => (store.hovered.value = null));
    canvas.addEventListener("dblclick", (event) => {
      const found = this.under(...local(event));
      if (found !== null) store.fold(found, !store.folded.peek().has(found));
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      zoom(local(event), Math.exp(-Math.min(Math.max(event.deltaY, -200), 200) * 0.002));
    }, { passive: false });
  }
}
