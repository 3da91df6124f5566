// One picture that the program makes for this page: what it shows, what can be set, and the camera. The split view has two.
import { batch, computed, signal } from "@preact/signals";

import { poseOf, rightOf, trueUp, worldOf, type Pose, type World } from "./camera";
import { Link, type Socket } from "./link";
import { VERSION, type CameraState, type Complaint, type Form, type Frame, type FrameHeader, type FromServer, type Layer, type SceneInfo, type Status, type Value } from "./protocol";

/** A frame that can be drawn. */
export interface Picture { header: FrameHeader; image: ImageBitmap }

export interface Start { session?: string | null; from?: string | null }

/** What was asked for and not answered yet; `next` waits until the program has answered. */
interface Order { value: Value | null; next: { value: Value | null } | null }

export function createSession(make: (query: string) => Socket, start: Start = {}) {
  const scene = signal<SceneInfo | null>(null);
  const camera = signal<CameraState | null>(null);
  const pose = signal<Pose | null>(null);
  const forms = signal<ReadonlyMap<string, Form>>(new Map());
  const status = signal<Status | null>(null);
  const layer = signal<Layer>("beauty");
  const layers = signal<Layer[]>(["beauty"]);
  const picture = signal<Picture | null>(null);
  const complaint = signal<Complaint | null>(null);
  const durer = signal("");
  /** Counts up with each change that other rays follow from: forms, camera, scene. */
  const changes = signal(0);
  const orders = signal<ReadonlyMap<string, Order>>(new Map());
  let seq = 0;
  let cameraWaits = false;

  const world = computed<World | null>(() => {
    const [at, here] = [scene.value, camera.value];
    return at && here ? worldOf(here, at.up, at.handedness, at.bounds) : null;
  });

  function take(list: Form[], all: boolean): void {
    const next = all ? new Map<string, Form>() : new Map(forms.peek());
    list.forEach((form) => next.set(form.id, form));
    forms.value = next;
    if (all) orders.value = new Map();
    else list.forEach((form) => settle(form.id));
    if (all || list.some((form) => form.id !== "look")) changes.value += 1;
  }

  /** The program has answered what was set of a form: sends what came in between. */
  function settle(id: string): void {
    const next = new Map(orders.peek());
    for (const [key, order] of next) {
      if (!key.startsWith(`${id} `)) continue;
      if (order.next) {
        next.set(key, { value: order.next.value, next: null });
        link.send({ type: "set", form: id, param: key.slice(id.length + 1), value: order.next.value });
      } else next.delete(key);
    }
    orders.value = next;
  }

  function stand(at: CameraState): void {
    camera.value = at;
    pose.value = poseOf(at);
  }

  function hear(message: FromServer): void {
    batch(() => {
      switch (message.type) {
        case "hello":
          if (message.version !== VERSION) return link.stop(`durer speaks version ${message.version} of the protocol, this page version ${VERSION}: reload the page`);
          durer.value = message.durer;
          scene.value = message.scene;
          stand(message.camera);
          [layer.value, layers.value] = [message.layer, message.layers];
          take(message.forms, true);
          status.value = message.status;
          cameraWaits = false;
          return;
        case "scene":
          scene.value = message.scene;
          stand(message.camera);
          return take(message.forms, true);
        case "camera": stand(message); changes.value += 1; return;
        case "forms": return take(message.forms, false);
        case "status": status.value = message; return;
        case "error":
          complaint.value = message;
          return settle(message.about);
        default: return;
      }
    });
  }

  /** Frames that came while one was decoded: only the newest matters. */
  let decoding = false;
  let newest: Frame | null = null;
  function look(frame: Frame): void {
    newest = frame;
    if (!decoding) void decode();
  }

  async function decode(): Promise<void> {
    decoding = true;
    while (newest) {
      const { header, png }: Frame = newest;
      newest = null;
      try {
        const image = await createImageBitmap(new Blob([png], { type: "image/png" }));
        picture.peek()?.image.close();
        picture.value = { header, image };
      } catch (error) {
        complaint.value = { about: "picture", message: `A frame could not be shown: ${String(error)}` };
      }
      link.send({ type: "ack", frame: header.frame });
    }
    decoding = false;
  }

  const link = new Link(make, { message: hear, frame: look }, start);

  /** Moves the camera: at once here, at most once per drawn frame there. */
  function move(to: Pose): void {
    pose.value = to;
    if (cameraWaits) return;
    cameraWaits = true;
    requestAnimationFrame(() => {
      if (!cameraWaits) return;
      cameraWaits = false;
      const at = pose.peek()!;
      const { eye, forward, up, distance } = at;
      seq += 1;
      link.send({ type: "camera", seq, eye, forward, up });
      const [was, around] = [camera.peek(), world.peek()];
      batch(() => {
        if (was && around) camera.value = { ...was, eye, forward, distance, right: rightOf(at, around), up: trueUp(at, around), exact: false };
        changes.value += 1;
      });
    });
  }

  /** The scene's own camera of a name; null is the first. */
  function stepInto(name: string | null): void {
    cameraWaits = false;
    seq += 1;
    link.send({ type: "camera", seq, name });
  }

  /** Sets a parameter; while the program is at it, only the newest value waits. */
  function set(form: string, param: string, value: Value | null): void {
    const key = `${form} ${param}`;
    const now = orders.peek().get(key);
    const next = new Map(orders.peek());
    if (now) next.set(key, { ...now, next: { value } });
    else {
      next.set(key, { value, next: null });
      link.send({ type: "set", form, param, value });
    }
    orders.value = next;
  }

  /** What a field shows: what was asked for last, else what the program has. */
  function asked(form: string, param: string): { value: Value | null } | null {
    const order = orders.value.get(`${form} ${param}`);
    return order ? order.next ?? order : null;
  }

  function choose(kind: string, form: string): void {
    link.send({ type: "kind", form, kind });
  }

  function reset(form: string | null): void {
    orders.value = new Map();
    link.send({ type: "reset", form });
  }

  function show(what: Layer): void {
    layer.value = what;
    link.send({ type: "layer", layer: what });
  }

  return { link, scene, camera, pose, world, forms, status, layer, layers, picture, complaint, durer, changes, move, stepInto, set, asked, choose, reset, show };
}

export type Session = ReturnType<typeof createSession>;
