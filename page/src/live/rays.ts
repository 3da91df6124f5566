// The ray tree of the chosen pixel, live: traced anew whenever the camera, the scene or an integrator's setting changes.
import { batch, computed, effect, signal } from "@preact/signals";

import { completed, NothingToShow } from "../data/load";
import type { Camera, Page, Scene } from "../data/types";
import type { Looks } from "../state/looks";
import { createStore, runPlayback, type Store } from "../state/store";
import type { CameraState, Rival, TraceReply } from "./protocol";
import type { Session } from "./session";

/** Milliseconds without change after which all samples of the pixel are asked for, and not only one. */
const REST = 350;

/** Widest small picture for Duerer's machine. */
const PAPER = 320;

export function createRays(session: Session, looks: Looks) {
  const pixel = signal<[number, number] | null>(null);
  const sample = signal<number | "brightest">(0);
  const rival = signal<Rival | null>(null);
  const store = signal<Store | null>(null);
  /** Counts up when the 3D view must be built anew, as of another scene. */
  const stage = signal(0);
  const problem = signal("");
  const busy = signal(false);
  const ms = signal<number | null>(null);
  const open = computed(() => pixel.value !== null);

  let ghost: { revision: number; scene: Scene } | null = null;
  let again: "one" | "all" | null = null;
  let resting: ReturnType<typeof setTimeout> | undefined;
  let endPlayback: (() => void) | null = null;
  let paper: Page["picture"] = null;

  async function scenery(): Promise<Scene> {
    const revision = session.scene.peek()?.revision ?? 0;
    if (ghost?.revision !== revision) {
      const reply = await session.link.ask("ghost", {});
      ghost = { revision: reply.revision, scene: reply.scene };
      stage.value += 1;
    }
    return ghost.scene;
  }

  function page(reply: TraceReply, scene: Scene): Page {
    const seen = session.camera.peek();
    const before = store.peek()?.page.scene;
    const camera = seen ? eyeOf(seen, scene.camera) : scene.camera;
    const same = before && sameEye(before.camera, camera);
    return completed({ ...reply.page, picture: paper, scene: { ...scene, camera: same ? before.camera : camera } });
  }

  function show(next: Page): void {
    batch(() => {
      problem.value = "";
      const old = store.peek();
      const wanted = sample.peek();
      const first = next.trees[0]!.sample;
      if (old && shownStage === stage.peek()) return old.replace(next, wanted === "brightest" ? first : wanted);
      const fresh = createStore(next, looks);
      if (old) {
        [fresh.tab.value, fresh.treeStyle.value, fresh.order.value, fresh.march.value] = [old.tab.peek(), old.treeStyle.peek(), old.order.peek(), old.march.peek()];
        fresh.machine.value = old.machine.peek();
      }
      fresh.ask.value = (index) => choose(index);
      endPlayback?.();
      endPlayback = runPlayback(fresh);
      store.value = fresh;
      shownStage = stage.peek();
    });
  }
  let shownStage = -1;

  /** Traces: one sample at once, or all. What is asked for meanwhile is traced afterwards, once. */
  async function trace(what: "one" | "all"): Promise<void> {
    if (busy.peek()) {
      again = again === "all" ? "all" : what;
      return;
    }
    const at = pixel.peek();
    if (!at || !session.link.open) return;
    busy.value = true;
    try {
      const scene = await scenery();
      const order = { x: at[0], y: at[1], sample: sample.peek(), samples: what === "all", diff: rival.peek() };
      const reply = await session.link.ask("trace", order);
      if (what === "all" || paper === null) paper = smallPicture(session);
      ms.value = reply.ms;
      if (pixel.peek()) show(page(reply, scene));
    } catch (error) {
      if (error instanceof NothingToShow || error instanceof Error) problem.value = error.message;
    }
    busy.value = false;
    const next = again;
    again = null;
    if (next) void trace(next);
  }

  /** Something has changed: one sample now, the others when it rests. */
  function renew(): void {
    clearTimeout(resting);
    if (!pixel.peek()) return;
    void trace("one");
    resting = setTimeout(() => void trace("all"), REST);
  }

  effect(() => {
    session.changes.value;
    pixel.value;
    sample.value;
    rival.value;
    if (session.link.state.value.is === "open") renew();
  });

  function choose(which: number | "brightest"): void {
    sample.value = which;
  }

  function close(): void {
    batch(() => {
      pixel.value = null;
      store.value = null;
      rival.value = null;
      problem.value = "";
    });
    endPlayback?.();
    endPlayback = null;
  }

  return { pixel, sample, rival, store, stage, problem, busy, ms, open, choose, close, renew };
}

export type Rays = ReturnType<typeof createRays>;

/** The camera as the tree's views know it. */
function eyeOf(seen: CameraState, ghost: Camera): Camera {
  const [fov_x, fov_y] = seen.fov ?? [ghost.fov_x, ghost.fov_y];
  return { eye: seen.eye, right: seen.right, up: seen.up, look: seen.forward, fov_x, fov_y, kind: seen.kind };
}

function sameEye(a: Camera, b: Camera): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

/** What is seen, small, for the machine's paper. */
function smallPicture(session: Session): Page["picture"] {
  const shown = session.picture.peek();
  if (!shown) return null;
  const [width, height] = shown.header.film;
  const share = Math.min(1, PAPER / width);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [Math.max(1, Math.round(width * share)), Math.max(1, Math.round(height * share))];
  canvas.getContext("2d")?.drawImage(shown.image, 0, 0, canvas.width, canvas.height);
  return { png: canvas.toDataURL("image/png"), width, height };
}
