// Mouse, pen and fingers on the 3D view: one moves around, two pinch and shift, a click selects.
import { Matrix4, Vector4 } from "three";

import type { Rig } from "./rig";
import type { RayLine } from "./rays";

/** The ray nearest to a place on the screen, within `reach` pixels. */
export function nearest(lines: RayLine[], seen: (line: RayLine) => boolean, rig: Rig, size: [number, number], at: [number, number], reach: number): number | null {
  const matrix = new Matrix4().multiplyMatrices(rig.camera.projectionMatrix, rig.camera.matrixWorldInverse);
  const [p, q] = [new Vector4(), new Vector4()];
  const near = rig.camera.near;
  let best: number | null = null;
  let least = reach;
  for (const line of lines) {
    if (!seen(line)) continue;
    p.set(line.a.x, line.a.y, line.a.z, 1).applyMatrix4(matrix);
    q.set(line.b.x, line.b.y, line.b.z, 1).applyMatrix4(matrix);
    if (p.w < near && q.w < near) continue;
    if (p.w < near) p.lerp(q, (near - p.w) / (q.w - p.w));
    else if (q.w < near) q.lerp(p, (near - q.w) / (p.w - q.w));
    const [ax, ay] = [((p.x / p.w + 1) / 2) * size[0], ((1 - p.y / p.w) / 2) * size[1]];
    const [bx, by] = [((q.x / q.w + 1) / 2) * size[0], ((1 - q.y / q.w) / 2) * size[1]];
    const d = distance(at, [ax, ay], [bx, by]) - line.width / 2;
    if (d < least) [least, best] = [d, line.node];
  }
  return best;
}

function distance([x, y]: [number, number], [ax, ay]: [number, number], [bx, by]: [number, number]): number {
  const [dx, dy] = [bx - ax, by - ay];
  const t = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
  return Math.hypot(ax + t * dx - x, ay + t * dy - y);
}

export interface Hands {
  hover(at: [number, number] | null): void;
  click(at: [number, number]): void;
  moved(): void;
}

export function attach(canvas: HTMLCanvasElement, rig: Rig, hands: Hands): void {
  const fingers = new Map<number, [number, number]>();
  let travelled = 0;
  let pans = false;
  const local = (event: PointerEvent): [number, number] => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, local(event));
    if (fingers.size === 1) travelled = 0;
    pans = event.button === 2 || event.button === 1 || event.shiftKey;
  });
  canvas.addEventListener("pointermove", (event) => {
    const at = local(event);
    const before = fingers.get(event.pointerId);
    if (!before) {
      if (event.pointerType === "mouse") hands.hover(at);
      return;
    }
    const [dx, dy] = [at[0] - before[0], at[1] - before[1]];
    travelled += Math.hypot(dx, dy);
    const height = canvas.clientHeight || 1;
    if (fingers.size === 2) {
      const other = [...fingers].find(([id]) => id !== event.pointerId)![1];
      const [was, is] = [before, at].map((p) => Math.hypot(p[0] - other[0], p[1] - other[1])) as [number, number];
      rig.dolly(was / Math.max(is, 1));
      rig.pan(dx / 2 / height, dy / 2 / height);
    } else if (travelled > 4) {
      hands.moved();
      if (pans) rig.pan(dx / height, dy / height);
      else rig.orbit((dx / height) * 3.4, (dy / height) * 3.4);
    }
    fingers.set(event.pointerId, at);
  });
  const up = (event: PointerEvent): void => {
    if (fingers.delete(event.pointerId) && fingers.size === 0 && travelled <= 4 && event.type === "pointerup") hands.click(local(event));
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => hands.hover(null));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    rig.dolly(Math.exp(Math.min(Math.max(event.deltaY, -200), 200) * 0.0016));
  }, { passive: false });
}
