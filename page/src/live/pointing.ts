// What is under the mouse or the mark: asked of the program, not too often, and again as the picture gets better.
import { effect, signal } from "@preact/signals";

import type { Pick } from "./protocol";
import type { Session } from "./session";
import type { Size } from "./zoom";

/** Milliseconds between questions. */
const PAUSE = 90;

export function createPointing(session: Session) {
  const hovered = signal<{ pixel: Size; found: Pick | null } | null>(null);
  let [asking, stale] = [false, false];

  /** Asks now, or as soon as the answer that is awaited came: it may be of an older picture. */
  function ask(): void {
    const at = hovered.peek();
    stale = asking;
    if (asking || !at) return;
    asking = true;
    const [x, y] = at.pixel;
    const here = (): boolean => hovered.peek()?.pixel[0] === x && hovered.peek()?.pixel[1] === y;
    const told = session.link.ask("pick", { x, y }).then((found) => {
      if (here()) hovered.value = { pixel: [x, y], found };
    }, () => undefined);
    const pause = new Promise((done) => setTimeout(done, PAUSE));
    void Promise.all([told, pause]).then(() => {
      asking = false;
      if (stale || !here()) ask();
    });
  }

  function point(pixel: Size | null): void {
    const was = hovered.peek()?.pixel;
    if (!pixel) hovered.value = null;
    else if (!was || was[0] !== pixel[0] || was[1] !== pixel[1]) {
      hovered.value = { pixel, found: null };
      ask();
    }
  }

  effect(() => {
    session.picture.value;
    ask();
  });

  return { hovered, point };
}
