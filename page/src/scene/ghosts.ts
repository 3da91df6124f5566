// The scene's objects as ghosts: seen at their edges, looked through elsewhere.
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  ShaderMaterial, SphereGeometry, Vector3, Vector4,
} from "three";

import { bytesOf } from "../data/load";
import { encode } from "../data/color";
import type { PackedMesh, Scene, SceneObject } from "../data/types";
import type { Space } from "./space";

/** More triangles than these get no lines along their edges. */
const MOST_WITH_EDGES = 20_000;

const VERTEX = /* glsl */ `
varying vec3 vNormal;
varying vec3 vWay;
varying vec3 vPlace;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vec4 p = viewMatrix * world;
  vPlace = world.xyz;
  vNormal = normalMatrix * normal;
  vWay = -p.xyz;
  gl_Position = projectionMatrix * p;
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
uniform vec3 uColor;
uniform float uOpacity;
uniform float uDark;
uniform vec4 uCut;
varying vec3 vNormal;
varying vec3 vWay;
varying vec3 vPlace;
void main() {
  if (dot(uCut.xyz, vPlace) > uCut.w) discard;
  float facing = abs(dot(normalize(vNormal), normalize(vWay)));
  float rim = pow(1.0 - facing, 2.2);
  vec3 ground = mix(vec3(0.42), vec3(0.62), uDark);
  vec3 color = mix(uColor, ground, 0.35 + 0.35 * rim) * mix(0.82 + 0.18 * facing, 1.0, uDark);
  gl_FragColor = vec4(color, clamp(uOpacity * (0.34 + 1.5 * rim), 0.0, 1.0));
}`;

export class Ghosts {
  readonly group = new Group();
  private readonly cut = { value: new Vector4(0, 0, 0, 1) };
  private readonly dark = { value: 0 };
  private readonly opacity = { value: 0.3 };
  private readonly edges: LineBasicMaterial[] = [];
  private readonly meshes: { name: string; mesh: Mesh }[] = [];

  constructor(scene: Scene, private readonly space: Space) {
    this.group.matrixAutoUpdate = false;
    this.group.matrix.copy(space.mirror);
    this.group.matrixWorldNeedsUpdate = true;
    scene.objects.forEach((object) => this.add(object));
    this.group.updateMatrixWorld(true);
  }

  private add(object: SceneObject): void {
    const geometry = shape(object);
    if (!geometry) return;
    const material = this.material(object);
    const triangles = (geometry.index?.count ?? geometry.getAttribute("position").count) / 3;
    const edged = !object.sphere && triangles <= MOST_WITH_EDGES ? new EdgesGeometry(geometry, 28) : null;
    const copies = object.copies?.length ? object.copies : [null];
    for (const [index, copy] of copies.slice(0, 500).entries()) {
      const mesh = new Mesh(geometry, material);
      const parts: (Mesh | LineSegments)[] = [mesh];
      if (edged) parts.push(new LineSegments(edged, this.edge()));
      for (const part of parts) {
        part.matrixAutoUpdate = false;
        if (copy) part.matrix.copy(placement(copy));
        this.group.add(part);
      }
      mesh.renderOrder = 1;
      this.meshes.push({ name: object.names?.[index] ?? object.name, mesh });
    }
  }

  private edge(): LineBasicMaterial {
    if (this.edges.length === 0) {
      this.edges.push(new LineBasicMaterial({ transparent: true, opacity: 0.35, depthWrite: false, toneMapped: false }));
    }
    return this.edges[0]!;
  }

  private material(object: SceneObject): ShaderMaterial {
    const color = object.color.map((x) => (Number.isFinite(x) ? encode(x) : 1)) as [number, number, number];
    const uniforms = {
      uColor: { value: new Color().setRGB(...color) }, uOpacity: this.opacity, uDark: this.dark, uCut: this.cut,
    };
    return new ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms, transparent: true, depthWrite: false, side: DoubleSide,
    });
  }

  theme(dark: boolean): void {
    this.dark.value = dark ? 1 : 0;
    this.edges.forEach((edge) => edge.color.set(dark ? 0xb8bcc4 : 0x4c4a45));
  }

  strength(opacity: number): void {
    this.opacity.value = opacity;
    this.edges.forEach((edge) => (edge.opacity = Math.min(1, opacity * 1.2)));
  }

  /** Takes away what lies beyond a plane; null takes away nothing. */
  section(normal: Vector3 | null, offset = 0): void {
    if (normal) this.cut.value.set(normal.x, normal.y, normal.z, offset);
    else this.cut.value.set(0, 0, 0, 1);
  }

  /** The parts of objects of a name, or of all, for rays to meet. */
  named(name: string | null): Mesh[] {
    return this.meshes.filter((part) => name === null || part.name === name).map((part) => part.mesh);
  }

  /** The ghosts' space seen from the world, for those who place things in it. */
  get mirror(): Matrix4 {
    return this.space.mirror;
  }
}

function shape(object: SceneObject): BufferGeometry | null {
  if (object.mesh) return unpack(object.mesh);
  if (!object.sphere) return null;
  const { center, radius } = object.sphere;
  return new SphereGeometry(radius, 64, 40).translate(...center);
}

/** Positions are 16-bit steps from an origin. */
function unpack(mesh: PackedMesh): BufferGeometry {
  const packed = new Uint16Array(bytesOf(mesh.positions).buffer);
  const bytes = bytesOf(mesh.indices).buffer;
  const scale = typeof mesh.scale === "number" ? [mesh.scale, mesh.scale, mesh.scale] : mesh.scale;
  const positions = new Float32Array(packed.length);
  for (let i = 0; i < packed.length; i++) positions[i] = mesh.origin[i % 3]! + scale[i % 3]! * packed[i]!;
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(mesh.wide ? new Uint32Array(bytes) : new Uint16Array(bytes), 1));
  // Small meshes are mostly boxes: flat faces; large ones mostly round things.
  const flat = (geometry.index?.count ?? 0) <= 1500 ? geometry.toNonIndexed() : geometry;
  flat.computeVertexNormals();
  return flat;
}

function placement(rows: number[]): Matrix4 {
  const [a, b, c, d, e, f, g, h, i, j, k, l] = rows as [number, number, number, number, number, number, number, number, number, number, number, number];
  return new Matrix4().set(a, b, c, d, e, f, g, h, i, j, k, l, 0, 0, 0, 1);
}
