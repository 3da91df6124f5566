// What the page and `durer view` say to each other: JSON messages, and frames that are a header and a PNG. docs/view.md tells more.
import type { Page, Scene, Vec3 } from "../data/types";

export type Layer = string;

/** What a PNG shows; sizes in pixels. */
export interface FrameHeader {
  frame: number;
  seq: number;
  revision: number;
  layer: Layer;
  film: [number, number];
  width: number;
  height: number;
  /** Samples per pixel that it holds; 0 while it is coarse. */
  samples: number;
  of: number;
  done: boolean;
  /** Since the change that began this picture. */
  ms: number;
  rays_per_s: number | null;
  white: number | null;
  range: [number, number] | null;
}

export interface Frame { header: FrameHeader; png: Uint8Array<ArrayBuffer> }

/** Where the camera stands. Unit vectors in the scene's world, `distance` in metres to what is seen in the middle. */
export interface CameraState {
  name: string | null;
  kind: string;
  eye: Vec3;
  forward: Vec3;
  up: Vec3;
  right: Vec3;
  fov: [number, number] | null;
  distance: number;
  exact: boolean;
}

export type Value =
  | boolean | number | string | number[] | string[]
  | { texture: string } | { spectrum: string | number[] } | { blackbody: number };

/** One parameter of a form; a null value is not given, then the default counts. */
export interface Param {
  name: string;
  type: string;
  doc: string;
  unit: string;
  default: Value | null;
  value: Value | null;
  min: number | null;
  max: number | null;
  words: string[] | null;
  editable: boolean;
}

/** What can be set of one thing. */
export interface Form {
  id: string;
  title: string;
  family: string;
  /** Null where there are no kinds. */
  kind: string | null;
  kinds: string[];
  doc?: string;
  params: Param[];
  changed: boolean;
}

export interface SceneInfo {
  name: string;
  revision: number;
  triangles: number;
  objects: number;
  bounds: [Vec3, Vec3] | null;
  handedness: "right" | "left";
  up: Vec3;
  cameras: string[];
  textures: { name: string; value: "color" | "float" }[];
  time: [number, number];
  warnings: string[];
}

export interface Status {
  state: "rendering" | "done" | "compiling" | "error";
  message: string | null;
  samples: number;
  of: number;
  rays_per_s: number | null;
  seconds: number;
  viewers: number;
}

export interface Complaint { about: string; param?: string | null; message: string; hint?: string | null; id?: number | null }

/** What stands at a pixel. */
export interface Pick {
  pixel: [number, number];
  object: string | null;
  index: number | null;
  material: string | null;
  form: string | null;
  light: string | null;
  t: number | null;
  depth: number | null;
  point: Vec3 | null;
  normal: Vec3 | null;
  uv: [number, number] | null;
  primitive: number | null;
  rgb: number[] | null;
  samples: number;
  revision: number;
}

export interface TraceReply { ms: number; revision: number; seq: number; page: Omit<Page, "scene" | "picture"> }
export interface GhostReply { revision: number; seq: number; scene: Scene }

/** Another integrator, or other parameters of it. */
export interface Rival { kind: string; params: Record<string, Value> }

export interface TraceOrder { x: number; y: number; sample: number | "brightest"; samples: boolean; diff: Rival | null }

export type FromServer =
  | { type: "hello"; version: number; durer: string; session: string; resumed: boolean; scene: SceneInfo; camera: CameraState; layer: Layer; layers: Layer[]; forms: Form[]; status: Status }
  | { type: "scene"; scene: SceneInfo; camera: CameraState; forms: Form[] }
  | ({ type: "camera" } & CameraState)
  | { type: "forms"; forms: Form[] }
  | ({ type: "status" } & Status)
  | ({ type: "error" } & Complaint)
  | ({ type: "trace"; id: number } & TraceReply)
  | ({ type: "pick"; id: number } & Pick)
  | ({ type: "ghost"; id: number } & GhostReply);

export type ToServer =
  | { type: "ack"; frame: number }
  | { type: "camera"; seq: number; eye: Vec3; forward: Vec3; up: Vec3 }
  | { type: "camera"; seq: number; name: string | null }
  | { type: "set"; form: string; param: string; value: Value | null }
  | { type: "kind"; form: string; kind: string }
  | { type: "reset"; form: string | null }
  | { type: "forms"; ids: string[] }
  | { type: "layer"; layer: Layer }
  | { type: "pause"; paused: boolean };

/** What is answered with the same `id`. */
export interface Requests {
  pick: { order: { x: number; y: number }; reply: Pick };
  trace: { order: TraceOrder; reply: TraceReply };
  ghost: { order: object; reply: GhostReply };
}

/** Version of the protocol that this page speaks. */
export const VERSION = 1;

/** Takes a binary message apart: length of the header, header, PNG. Null if it is none. */
export function readFrame(data: ArrayBuffer): Frame | null {
  if (data.byteLength < 4) return null;
  const length = new DataView(data).getUint32(0, true);
  if (length > data.byteLength - 4) return null;
  try {
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length))) as FrameHeader;
    return { header, png: new Uint8Array(data, 4 + length) };
  } catch {
    return null;
  }
}

/** A message of the server; null if it cannot be read. */
export function readMessage(text: string): FromServer | null {
  try {
    const message = JSON.parse(text) as FromServer | null;
    return message !== null && typeof message === "object" && typeof message.type === "string" ? message : null;
  } catch {
    return null;
  }
}
