// The document that the page holds: what `durer trace` writes, version 1. What is absent is null or left out.

export type Vec3 = [number, number, number];
export type Rgb = [number, number, number];

export type Kind =
  | "eye" | "shadow" | "reflection" | "refraction" | "glossy-reflection" | "glossy-refraction" | "passing"
  | "scattered"
  | "diffuse-bounce" | "environment" | "light-sample" | "bsdf-sample" | "connection" | "photon";

export interface LightFact {
  index: number;
  name: string | null;
  point: Vec3 | null;
  visible: boolean;
  passed?: Rgb;
  unoccluded: Rgb;
}

export interface Body { object: string; priority?: number | null; ior: number }

export interface Lobe {
  name: string;
  reflectance?: Rgb | null;
  transmittance?: Rgb | null;
  exponent?: number | null;
  alpha?: number | null;
}

export interface Drawn {
  from: string;
  pdf?: number | null;
  other_pdf?: number | null;
  mis?: number | null;
  f?: Rgb | null;
  cos?: number | null;
  lobe?: string | null;
  /** Rays among which the light is shared. */
  rays?: number | null;
  /** Probability with which this light was chosen among all. */
  chance?: number | null;
  /** Probability with which chance let the ray live. */
  kept?: number | null;
}

export interface TextureLookup {
  name: string;
  uv: [number, number];
  value: number[];
  footprint?: number | null;
  level?: number | null;
}

export interface WalkedBox { box: [Vec3, Vec3]; depth: number; hit: boolean }

export interface Tests {
  boxes: number;
  primitives: number;
  triangles?: number;
  shapes?: number;
  curves?: number;
  points?: number;
}

/** Rays that there was no room for in the page: how many, what they add to the pixel, what they bring to the ray above. */
export interface LeftOut { rays: number; contribution: Rgb; result: Rgb }

/** What floats on the way of a ray. */
export interface Floating {
  medium: string;
  weight: Rgb;
  /** Of `local`, what the medium sends out on the way. */
  sent: Rgb;
  passed: number;
  scattered?: { point: Vec3; sigma_a: Rgb; sigma_s: Rgb; phase: string; g: number } | null;
}

/** One ray. */
export interface Node {
  id: number;
  parent: number | null;
  kind: Kind;
  depth: number;
  origin: Vec3;
  direction: Vec3;
  t: number | null;
  point: Vec3 | null;
  object: string | null;
  primitive: number | null;
  normal: Vec3 | null;
  uv: [number, number] | null;
  side: "outside" | "inside" | null;
  weight: Rgb;
  throughput: Rgb;
  local: Rgb;
  contribution: Rgb;
  result: Rgb;
  stop: string | null;
  lost: Rgb;
  light: LightFact | null;
  blocker: string | null;
  tests?: Tests | null;
  instance?: number | null;
  material?: string | null;
  geometric_normal?: Vec3 | null;
  barycentric?: Vec3 | null;
  triangle?: [Vec3, Vec3, Vec3] | null;
  cos?: number | null;
  time?: number | null;
  floating?: Floating | null;
  /** Light that photons brought. */
  gathered?: { photons: number; radius: number; radiance: Rgb } | null;
  media?: { before?: Body[] | null; after?: Body[] | null; n1: number; n2: number } | null;
  fresnel?: { reflect: number; transmit: number; critical_angle?: number | null; tir: boolean; constant?: boolean | null; eta?: number | null } | null;
  lobes?: Lobe[] | null;
  drawn?: Drawn | null;
  arrived?: Rgb | null;
  emission?: Rgb | null;
  ambient?: Rgb | null;
  blurred_sky?: Rgb | null;
  random?: { dim: string; u: number[] }[] | null;
  sampler?: string | null;
  textures?: TextureLookup[] | null;
  limit?: { value: number; threshold: number } | null;
  ns?: number | null;
  walk?: WalkedBox[] | null;
  /** Its id in the whole tree, where this one was cut. */
  whole_id?: number | null;
  /** What is missing below it. */
  left_out?: LeftOut | null;
}

/** What another way of tracing changes in a sample, as the program found it. */
export interface Diff {
  options: string;
  summary: string;
  removed?: number[] | null;
  added?: number[] | null;
  changed?: { before: number; after: number; keys: string[] }[] | null;
  pairs?: [number, number][] | null;
}

/** The rays of one pixel sample, parents before children. */
export interface Tree {
  version: number;
  scene: string;
  integrator: string;
  width: number;
  height: number;
  pixel: [number, number];
  sample: number;
  rgb: Rgb;
  nodes: Node[];
  samples?: number | null;
  durer?: string | null;
  antialias?: string | null;
  filter_weight?: number | null;
  film?: [number, number] | null;
  lens?: [number, number] | null;
  time?: number | null;
  rules?: Record<string, unknown> | null;
  killed?: Rgb | null;
  max_radiance?: number | null;
  /** How much of `rgb` is missing at most. */
  missing?: Rgb | null;
  /** Why that cannot be said. */
  no_bound?: string | null;
  diff?: Diff | null;
  /** What is missing of the tree. */
  left_out?: LeftOut | null;
}

export interface PackedMesh {
  origin: Vec3;
  scale: number | Vec3;
  positions: string;
  indices: string;
  wide: boolean;
}

export interface SceneObject {
  name: string;
  material: string | null;
  color: Rgb;
  emits: boolean;
  mesh: PackedMesh | null;
  copies?: number[][] | null;
  /** One for each copy, where they differ. */
  names?: string[] | null;
  sphere?: { center: Vec3; radius: number } | null;
  plane?: boolean | null;
}

export interface SceneLight {
  index: number;
  name: string | null;
  kind: string;
  point: Vec3 | null;
  direction: Vec3 | null;
  color: Rgb | null;
}

export interface Camera {
  eye: Vec3;
  right: Vec3;
  up: Vec3;
  look: Vec3;
  fov_x: number;
  fov_y: number;
  kind: string;
}

export interface Scene {
  name: string;
  bounds: [Vec3, Vec3] | null;
  camera: Camera;
  objects: SceneObject[];
  lights: SceneLight[];
}

export interface SampleDims { film?: [number, number] | null; lens?: [number, number] | null; time?: number | null }

/** All that the page shows. */
export interface Page {
  version: number;
  trees: Tree[];
  other: { options: string; trees: Tree[] } | null;
  values: Rgb[];
  dims: SampleDims[];
  mean: Rgb;
  picture: { png: string; width: number; height: number } | null;
  scene: Scene;
  /** What else there was no room for, in words. */
  left_out?: string[] | null;
}
