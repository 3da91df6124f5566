// From the world to the space of the 3D view: right-handed, worlds of the other kind are mirrored, and of unit size.
import { Matrix4, Sphere, Vector3 } from "three";

import { cross, dot } from "../data/vector";
import type { Page, Vec3 } from "../data/types";
import { whole } from "./frame";

export class Space {
  /** -1 if z is turned around. */
  readonly hand: number;
  /** Around all that is seen: the unit ball. */
  readonly bounds = new Sphere(new Vector3(), 1);
  /** Axis of the view that is up: 0, 1 or 2, and which way. */
  readonly up: Vector3;
  /** The view's space from the world. */
  readonly matrix: Matrix4;
  private readonly center: Vec3;
  private readonly radius: number;

  constructor(page: Page) {
    const { right, up, look } = page.scene.camera;
    this.hand = dot(right, cross(look, up)) < 0 ? -1 : 1;
    ({ center: this.center, radius: this.radius } = whole(page));
    const [x, y, z] = this.center;
    this.matrix = new Matrix4().makeScale(1 / this.radius, 1 / this.radius, this.hand / this.radius)
      .multiply(new Matrix4().makeTranslation(-x, -y, -z));
    this.up = dominant(this.direction(up));
  }

  place(p: Vec3): Vector3 {
    const [x, y, z] = this.center;
    return new Vector3((p[0] - x) / this.radius, (p[1] - y) / this.radius, ((p[2] - z) / this.radius) * this.hand);
  }

  direction(d: Vec3): Vector3 {
    return new Vector3(d[0], d[1], d[2] * this.hand).normalize();
  }

  /** A length of the world in the view. */
  length(metres: number): number {
    return metres / this.radius;
  }

  /** And back. */
  metres(length: number): number {
    return length * this.radius;
  }
}

function dominant(v: Vector3): Vector3 {
  const [x, y, z] = [Math.abs(v.x), Math.abs(v.y), Math.abs(v.z)];
  if (y >= x && y >= z) return new Vector3(0, Math.sign(v.y) || 1, 0);
  return z >= x ? new Vector3(0, 0, Math.sign(v.z) || 1) : new Vector3(Math.sign(v.x) || 1, 0, 0);
}
