// Mouse, pen, fingers and wheel on the live picture.

type Place = [number, number];

export interface Hands {
  /** One finger or the left button: by screen pixels; `height`: of the picture. */
  drag(dx: number, dy: number): void;
  /** Two fingers, the right or middle button, or Shift. */
  shift(dx: number, dy: number): void;
  /** Two fingers or the wheel: above 1 is away; `fine`: the wheel with Ctrl, as a touch pad pinches. */
  pinch(factor: number, at: Place, fine: boolean): void;
  click(at: Place, only: boolean): void;
  hover(at: Place | null): void;
}

/** Pixels that a click may shake. */
const SHAKE = 4;

/** Until what it returns is called. */
export function attach(canvas: HTMLElement, hands: Hands): () => void {
  const ending = new AbortController();
  const on = <K extends keyof HTMLElementEventMap>(type: K, what: (event: HTMLElementEventMap[K]) => void): void =>
    canvas.addEventListener(type, what, { signal: ending.signal, passive: false });
  const fingers = new Map<number, Place>();
  let travelled = 0;
  let shifts = false;
  const local = (event: MouseEvent): Place => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  on("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, local(event));
    travelled = fingers.size === 1 ? 0 : SHAKE + 1;
    shifts = event.button === 2 || event.button === 1 || event.shiftKey;
  });
  on("pointermove", (event) => {
    const at = local(event);
    const before = fingers.get(event.pointerId);
    if (!before) {
      if (event.pointerType !== "touch") hands.hover(at);
      return;
    }
    const [dx, dy] = [at[0] - before[0], at[1] - before[1]];
    travelled += Math.hypot(dx, dy);
    if (fingers.size === 2) {
      const other = [...fingers].find(([id]) => id !== event.pointerId)![1];
      const [was, is] = [before, at].map((p) => Math.hypot(p[0] - other[0], p[1] - other[1])) as Place;
      hands.pinch(was / Math.max(is, 1), [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2], false);
      hands.shift(dx / 2, dy / 2);
    } else if (travelled > SHAKE) {
      if (shifts) hands.shift(dx, dy);
      else hands.drag(dx, dy);
    }
    fingers.set(event.pointerId, at);
  });
  const up = (event: PointerEvent): void => {
    if (!fingers.delete(event.pointerId) || fingers.size > 0) return;
    if (travelled <= SHAKE && event.type === "pointerup" && event.button === 0) hands.click(local(event), event.altKey || event.ctrlKey || event.metaKey);
  };
  on("pointerup", up);
  on("pointercancel", up);
  on("pointerleave", () => hands.hover(null));
  on("contextmenu", (event) => event.preventDefault());
  on("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 33 : 1;
    const by = Math.min(Math.max(event.deltaY * lines, -200), 200);
    hands.pinch(Math.exp(by * (event.ctrlKey ? 0.008 : 0.0016)), local(event), event.ctrlKey);
  });
  return () => ending.abort();
}
