// What the live page shows and does: the picture, what it is compared with, the chosen pixel, and where the hands go.
import { batch, computed, effect, signal } from "@preact/signals";

import { createLooks } from "../state/looks";
import { dolly, fly, look, orbit, pan, pivotAt, type Pose, type World } from "./camera";
import type { Socket } from "./link";
import { createPointing } from "./pointing";
import { createRays } from "./rays";
import { createSession, type Session, type Start } from "./session";
import type { Pick } from "./protocol";
import { fitting, pixelAt, placed, shifted, zoomed, type Size, type Zoom } from "./zoom";

export type SceneTab = "look" | "render" | "camera" | "lights" | "materials" | "scene";
export type Side = "scene" | "rays";
export type Hand = "orbit" | "fly" | "zoom";
export type Pane = "picture" | "space";

/** What is right of the divider. */
export type Against = { is: "session"; session: Session } | { is: "image"; image: ImageBitmap; name: string; light: Blob | null };

/** Radians for a drag as high as the picture. */
const TURN = 3.4;

export function createLive(make: (query: string) => Socket, start: Start = {}) {
  const looks = createLooks();
  const main = createSession(make, start);
  const rays = createRays(main, looks);
  const tab = signal<SceneTab>("look");
  const side = signal<Side>("scene");
  const hand = signal<Hand>("orbit");
  /** What small screens show above. */
  const pane = signal<Pane>("picture");
  const zoom = signal<Zoom>(null);
  const size = signal<Size>([1, 1]);
  const against = signal<Against | null>(null);
  const divide = signal(0.5);
  const paused = signal(false);
  const cursor = signal<Size | null>(null);
  const { hovered, point } = createPointing(main);
  const picked = signal<Pick | null>(null);
  /** The form that was asked for by a click on an object. */
  const shownForm = signal<string | null>(null);

  const film = computed<Size>(() => main.picture.value?.header.film ?? [16, 9]);
  const lying = computed(() => placed(zoom.value, size.value, film.value));

  function moving(how: (pose: Pose, world: World) => Pose): void {
    const [pose, world] = [main.pose.peek(), main.world.peek()];
    if (!pose || !world) return;
    const next = how(pose, world);
    main.move(next);
    const other = against.peek();
    if (other?.is === "session") other.session.move(next);
  }

  const opening = (): number => main.camera.peek()?.fov?.[1] ?? 45;
  /** Height of the film on the screen: what drags are measured by. */
  const tall = (): number => Math.max(film.peek()[1] * lying.peek().scale, 1);

  const hands = {
    drag(dx: number, dy: number): void {
      if (hand.peek() === "zoom") zoom.value = shifted(zoom.peek(), dx, dy, film.peek());
      else if (hand.peek() === "fly") moving((pose, world) => look(pose, world, -(dx / tall()) * TURN * 0.5, (dy / tall()) * TURN * 0.5));
      else moving((pose, world) => orbit(pose, world, (dx / tall()) * TURN, (dy / tall()) * TURN));
    },
    shift(dx: number, dy: number): void {
      if (hand.peek() === "zoom") zoom.value = shifted(zoom.peek(), dx, dy, film.peek());
      else moving((pose, world) => pan(pose, world, dx / tall(), dy / tall(), opening()));
    },
    pinch(factor: number, at: Size, fine: boolean): void {
      if (hand.peek() === "zoom" || fine) zoom.value = zoomed(zoom.peek(), 1 / factor, at, size.peek(), film.peek());
      else if (hand.peek() === "fly") moving((pose, world) => fly(pose, world, -Math.log(factor), 0, 0));
      else moving((pose, world) => dolly(pose, world, factor));
    },
    click(at: Size, only: boolean): void {
      const pixel = pixelAt(at, lying.peek(), film.peek());
      if (pixel) choose(pixel, only);
    },
    hover(at: Size | null): void {
      point(at && pixelAt(at, lying.peek(), film.peek()));
    },
  };

  /** Takes a pixel: what is there, and its rays, unless only the object is asked for. */
  function choose(pixel: Size, only = false): void {
    cursor.value = pixel;
    const [x, y] = pixel;
    main.link.ask("pick", { x, y }).then((found) => {
      batch(() => {
        picked.value = found;
        const pose = main.pose.peek();
        if (found.depth && pose) main.pose.value = pivotAt(pose, found.depth);
      });
      looks.say(found.object ? `Pixel ${x}, ${y}: ${found.object}${found.material ? `, ${found.material}` : ""}` : `Pixel ${x}, ${y}: nothing there`);
    }, () => undefined);
    if (only) return;
    batch(() => {
      rays.pixel.value = pixel;
      side.value = "rays";
    });
  }

  function showForm(id: string): void {
    // Of very many materials the program sends only those that are asked for.
    if (!main.forms.peek().has(id)) main.link.send({ type: "forms", ids: [id] });
    batch(() => {
      side.value = "scene";
      tab.value = id.startsWith("material") ? "materials" : id.includes("light") ? "lights" : "render";
      shownForm.value = id;
    });
  }

  function closeRays(): void {
    rays.close();
    batch(() => {
      side.value = "scene";
      pane.value = "picture";
    });
  }

  /** An integrator to compare with if none is named: paths with all others, and the lecture's with paths. */
  function rivalKind(): string | null {
    const form = main.forms.peek().get("integrator");
    return ["path", "whitted"].find((kind) => form?.kinds.includes(kind) && form.kind !== kind) ?? null;
  }

  /** A second picture of the same scene, seen by the same camera. */
  function split(kind = rivalKind()): void {
    unsplit();
    const from = main.link.session;
    if (!from) return;
    const session = createSession(make, { from });
    against.value = { is: "session", session };
    const stop = effect(() => {
      if (session.scene.value === null) return;
      queueMicrotask(() => stop());
      if (kind) session.choose(kind, "integrator");
    });
  }

  /** Holds a picture against this one. `light` is the file that durer developed it from, and will again when exposure or tone map change. */
  function hold(image: ImageBitmap, name: string, light: Blob | null = null): void {
    unsplit();
    against.value = { is: "image", image, name, light };
  }

  /** A file of light as this picture is shown. */
  async function developed(light: Blob): Promise<ImageBitmap> {
    const words = new URLSearchParams(location.search);
    words.set("session", main.link.session ?? "");
    const answer = await fetch(`/develop?${words}`, { method: "POST", body: light });
    if (!answer.ok) throw new Error((await answer.text()).trim() || `${answer.status} ${answer.statusText}`);
    return createImageBitmap(await answer.blob());
  }

  /** Opens a picture's file: by the browser, or by durer what holds light. */
  async function compareWith(file: File): Promise<void> {
    const image = await createImageBitmap(file).catch(() => null);
    if (image) hold(image, file.name);
    else hold(await developed(file), file.name, file);
  }

  // What is compared is shown alike.
  const shownAs = computed(() => JSON.stringify([main.forms.value.get("integrator")?.kind, main.forms.value.get("look")?.params.map((param) => param.value)]));
  let first = true;
  effect(() => {
    void shownAs.value;
    const now = against.peek();
    if (first || now?.is !== "image" || !now.light) return void (first = false);
    const { light, name } = now;
    developed(light).then((image) => {
      const still = against.peek();
      if (still?.is === "image" && still.light === light) hold(image, name, light);
      else image.close();
    }, () => undefined);
  });

  function unsplit(): void {
    const was = against.peek();
    if (was?.is === "session") was.session.link.close();
    if (was?.is === "image") was.image.close();
    against.value = null;
  }

  function home(name: string | null): void {
    main.stepInto(name);
    const other = against.peek();
    if (other?.is === "session") other.session.stepInto(name);
  }

  function pause(on: boolean): void {
    paused.value = on;
  }

  // A hidden page wants no samples.
  const hidden = signal(document.hidden);
  document.addEventListener("visibilitychange", () => (hidden.value = document.hidden));
  effect(() => {
    const still = paused.value || hidden.value;
    const other = against.value;
    const all = other?.is === "session" ? [main, other.session] : [main];
    for (const { link } of all) if (link.state.value.is === "open") link.send({ type: "pause", paused: still });
  });
  // Whoever comes back does not wait.
  effect(() => {
    if (!hidden.value) main.link.retry();
  });
  addEventListener("online", () => main.link.retry());

  /** Enlarges around the middle; null fits. */
  function enlarge(factor: number | null): void {
    const [w, h] = size.peek();
    zoom.value = factor === null ? null : zoomed(zoom.peek(), factor, [w / 2, h / 2], [w, h], film.peek());
  }

  /** One pixel of the film is one of the screen's points. */
  function actual(): void {
    enlarge(1 / (zoom.peek()?.scale ?? fitting(size.peek(), film.peek())));
  }

  return {
    looks, main, rays, tab, side, hand, pane, zoom, size, film, lying, against, divide, paused, cursor, hovered, picked, shownForm,
    hands, moving, opening, point, choose, showForm, closeRays, split, hold, compareWith, unsplit, home, pause, enlarge, actual,
  };
}

export type Live = ReturnType<typeof createLive>;
