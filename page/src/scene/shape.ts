// Forms of objects as triangles, and where they are in the view.
import { BufferAttribute, BufferGeometry, EdgesGeometry, Matrix4, Vector3 } from "three";

import { bytesOf } from "../data/load";
import type { SceneObject } from "../data/types";
import { corners, moved } from "./frame";
import type { Space } from "./space";

/** More triangles than these get no lines along their edges. */
const MOST_WITH_EDGES = 20_000;
/** Half the edge of the part of an endless plane that is drawn, by the radius of all that is seen. */
const PLANE = 3.2;
/** Length of a step of a packed mesh in its geometry: three compares places for edges to four digits. */
const STEP = 1e-4;

/** Triangles without an index, with normals; of an endless plane in the view's space, else in steps from the mesh's own
 * corner. Null if there are none. */
export function shape(object: SceneObject, space: Space): BufferGeometry | null {
  const { mesh } = object;
  if (!mesh) return null;
  if (object.plane) return plane(object, space);
  const steps = new Uint16Array(bytesOf(mesh.positions).buffer);
  const bytes = bytesOf(mesh.indices).buffer;
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(steps, (q) => q * STEP), 3));
  const index = mesh.wide ? new Uint32Array(bytes) : new Uint16Array(bytes);
  geometry.setIndex(new BufferAttribute(index, 1));
  // Small meshes are mostly boxes: flat faces; large ones mostly round things.
  if (index.length > 1500) geometry.computeVertexNormals();
  const flat = geometry.toNonIndexed();
  if (index.length <= 1500) flat.computeVertexNormals();
  return flat;
}

/** Where copies of the form are. */
export function placements(object: SceneObject, space: Space): Matrix4[] {
  if (object.plane) return [new Matrix4()];
  const own = new Matrix4();
  if (object.sphere) {
    const { center: [x, y, z], radius } = object.sphere;
    own.makeTranslation(x, y, z).multiply(new Matrix4().makeScale(radius, radius, radius));
  } else if (object.mesh) {
    const { origin: [x, y, z], scale } = object.mesh;
    const [a, b, c] = typeof scale === "number" ? [scale, scale, scale] : scale;
    own.makeTranslation(x, y, z).multiply(new Matrix4().makeScale(a / STEP, b / STEP, c / STEP));
  }
  const copies = object.copies?.length ? object.copies : [null];
  // Numbers of matrices are in double precision until they are drawn.
  return copies.map((copy) => {
    const world = copy ? placement(copy).multiply(own) : own;
    return new Matrix4().multiplyMatrices(space.matrix, world);
  });
}

/** The part of an endless plane that is seen. */
function plane(object: SceneObject, space: Space): BufferGeometry | null {
  const [copy] = object.copies ?? [];
  const [a, b, c] = corners(object).map((p) => space.place(copy ? moved(copy, p) : p));
  if (!a || !b || !c) return null;
  const u = b.clone().sub(a).normalize();
  const n = u.clone().cross(c.clone().sub(a)).normalize();
  if (n.lengthSq() < 0.5) return null;
  const v = n.clone().cross(u);
  const foot = n.clone().multiplyScalar(n.dot(a));
  const at = (s: number, t: number): number[] => foot.clone().addScaledVector(u, s * PLANE).addScaledVector(v, t * PLANE).toArray();
  const geometry = new BufferGeometry();
  const [p, q, r, s] = [at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)];
  geometry.setAttribute("position", new BufferAttribute(new Float32Array([p, q, r, p, r, s].flat()), 3));
  geometry.computeVertexNormals();
  return geometry;
}

/** Edges where faces meet at an angle, and borders. */
export function edgesOf(geometry: BufferGeometry): BufferGeometry | null {
  const triangles = geometry.getAttribute("position").count / 3;
  return triangles <= MOST_WITH_EDGES ? new EdgesGeometry(geometry, 28) : null;
}

function placement(rows: number[]): Matrix4 {
  const [a, b, c, d, e, f, g, h, i, j, k, l] = rows as [number, number, number, number, number, number, number, number, number, number, number, number];
  return new Matrix4().set(a, b, c, d, e, f, g, h, i, j, k, l, 0, 0, 0, 1);
}

/** The matrix that takes normals along: cofactors, so that nothing is divided. */
export function normalMatrix(m: Matrix4): (n: Vector3) => Vector3 {
  const [x, y, z] = [new Vector3(), new Vector3(), new Vector3()];
  m.extractBasis(x, y, z);
  const [yz, zx, xy] = [y.clone().cross(z), z.clone().cross(x), x.clone().cross(y)];
  return (n) => {
    const [a, b, c] = [n.x, n.y, n.z];
    return n.set(0, 0, 0).addScaledVector(yz, a).addScaledVector(zx, b).addScaledVector(xy, c).normalize();
  };
}
