// The scene's objects as ghosts: seen at their edges, looked through elsewhere. All of them are few draws: one for the
// faces of most, one for their edges, one for whole spheres; meshes with many copies have one each.
import {
  BufferGeometry, DoubleSide, Group, InstancedBufferAttribute, InstancedMesh, LineBasicMaterial, LineSegments,
  Matrix4, Mesh, MeshBasicMaterial, ShaderMaterial, SphereGeometry, Vector3, Vector4,
} from "three";

import { encode } from "../data/color";
import type { Scene, SceneObject } from "../data/types";
import { edgesOf, placements, shape } from "./shape";
import type { Space } from "./space";
import { Baker } from "./baker";

/** Triangles that are copied to where they are seen; meshes that do not fit are drawn by the card's own copying. */
const MOST_BAKED = 150_000;
/** Ends of edges in all. */
const MOST_EDGES = 400_000;

const VERTEX = /* glsl */ `
attribute vec3 ink;
varying vec3 vColor;
varying vec3 vNormal;
varying vec3 vWay;
varying vec3 vPlace;
void main() {
  vColor = ink;
#ifdef USE_INSTANCING
  vec4 world = modelMatrix * instanceMatrix * vec4(position, 1.0);
  mat3 m = mat3(instanceMatrix);
  // The matrix of cofactors: right for normals however the copy is stretched; length does not matter.
  vec3 n = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])) * normal;
#else
  vec4 world = modelMatrix * vec4(position, 1.0);
  vec3 n = normal;
#endif
  vec4 p = viewMatrix * world;
  vPlace = world.xyz;
  vNormal = normalMatrix * normalize(n);
  vWay = -p.xyz;
  gl_Position = projectionMatrix * p;
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
uniform float uOpacity;
uniform float uDark;
uniform vec4 uCut;
varying vec3 vColor;
varying vec3 vNormal;
varying vec3 vWay;
varying vec3 vPlace;
void main() {
  if (dot(uCut.xyz, vPlace) > uCut.w) discard;
  float facing = abs(dot(normalize(vNormal), normalize(vWay)));
  float rim = pow(1.0 - facing, 2.2);
  vec3 ground = mix(vec3(0.42), vec3(0.62), uDark);
  vec3 color = mix(vColor, ground, 0.35 + 0.35 * rim) * mix(0.82 + 0.18 * facing, 1.0, uDark);
  gl_FragColor = vec4(color, clamp(uOpacity * (0.34 + 1.5 * rim), 0.0, 1.0));
}`;

/** A form with all the places where it is. */
interface Thing { object: SceneObject; geometry: BufferGeometry; places: Matrix4[]; triangles: number }

export class Ghosts {
  readonly group = new Group();
  private readonly cut = { value: new Vector4(0, 0, 0, 1) };
  private readonly dark = { value: 0 };
  private readonly opacity = { value: 0.3 };
  private readonly material = new ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthWrite: false, side: DoubleSide,
    uniforms: { uOpacity: this.opacity, uDark: this.dark, uCut: this.cut },
  });
  private readonly edges = new LineBasicMaterial({ transparent: true, opacity: 0.35, depthWrite: false, toneMapped: false });
  /** For rays to meet; never drawn. */
  private readonly solids = new Map<string, Mesh[]>();

  constructor(scene: Scene, space: Space) {
    const round = new SphereGeometry(1, 64, 40);
    const things = scene.objects.flatMap((object): Thing[] => {
      const geometry = object.sphere ? round : shape(object, space);
      const places = placements(object, space);
      return geometry ? [{ object, geometry, places, triangles: (geometry.getAttribute("position").count / 3) * places.length }] : [];
    });
    things.forEach((thing) => this.solidify(thing));
    const meshes = things.filter((thing) => !thing.object.sphere).sort((a, b) => a.triangles - b.triangles);
    const faces = new Baker();
    let triangles = 0;
    for (const thing of meshes) {
      triangles += thing.triangles;
      if (triangles <= MOST_BAKED) thing.places.forEach((place) => faces.add(thing.geometry, place, inkOf(thing.object)));
      else this.draw(this.copies(thing.geometry, thing.places, () => inkOf(thing.object)));
    }
    this.draw(faces.mesh(this.material));
    const spheres = things.filter((thing) => thing.object.sphere);
    // A thousand spheres need not be as round as one.
    const ball = spheres.length > 40 ? new SphereGeometry(1, 24, 16) : round;
    if (spheres.length > 0) this.draw(this.copies(ball, spheres.flatMap((s) => s.places), (i) => inkOf(spheres[i]!.object)));
    this.draw(this.wires(meshes));
  }

  private draw(part: Mesh | LineSegments | null): void {
    if (!part) return;
    part.renderOrder = 1;
    part.frustumCulled = false;
    part.matrixAutoUpdate = false;
    this.group.add(part);
  }

  private copies(geometry: BufferGeometry, places: Matrix4[], ink: (index: number) => [number, number, number]): InstancedMesh {
    const own = geometry.clone();
    own.setAttribute("ink", new InstancedBufferAttribute(new Float32Array(places.flatMap((_, i) => ink(i))), 3));
    const mesh = new InstancedMesh(own, this.material, places.length);
    places.forEach((place, i) => mesh.setMatrixAt(i, place));
    return mesh;
  }

  /** Lines along the edges, of small things first. */
  private wires(things: Thing[]): LineSegments | null {
    const baker = new Baker();
    for (const { geometry, places } of things) {
      const edges = edgesOf(geometry);
      if (!edges) continue;
      if (baker.size + edges.getAttribute("position").count * places.length > MOST_EDGES) break;
      places.forEach((place) => baker.add(edges, place, null));
    }
    return baker.lines(this.edges);
  }

  private solidify({ object, geometry, places }: Thing): void {
    places.forEach((place, index) => {
      const mesh = new Mesh(geometry, SOLID);
      mesh.matrixWorld.copy(place);
      const name = object.names?.[index] ?? object.name;
      this.solids.set(name, [...(this.solids.get(name) ?? []), mesh]);
    });
  }

  theme(dark: boolean): void {
    this.dark.value = dark ? 1 : 0;
    this.edges.color.set(dark ? 0xb8bcc4 : 0x4c4a45);
  }

  strength(opacity: number): void {
    this.opacity.value = opacity;
    this.edges.opacity = Math.min(1, opacity * 1.2);
  }

  /** Takes away what lies beyond a plane; null takes away nothing. */
  section(normal: Vector3 | null, offset = 0): void {
    if (normal) this.cut.value.set(normal.x, normal.y, normal.z, offset);
    else this.cut.value.set(0, 0, 0, 1);
  }

  /** The parts of objects of a name, or of all, for rays to meet. */
  named(name: string | null): Mesh[] {
    return name === null ? [...this.solids.values()].flat() : (this.solids.get(name) ?? []);
  }
}

const SOLID = new MeshBasicMaterial({ side: DoubleSide });

function inkOf(object: SceneObject): [number, number, number] {
  return object.color.map((x) => (Number.isFinite(x) ? encode(x) : 1)) as [number, number, number];
}
