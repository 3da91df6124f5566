// From the world to the space of the 3D view, which is right-handed: worlds of the other kind are mirrored.
import { Box3, Matrix4, Sphere, Vector3 } from "three";

import { cross, dot } from "../data/vector";
import type { Page, Vec3 } from "../data/types";

export class Space {
  /** -1 if z is turned around. */
  readonly hand: number;
  readonly bounds: Sphere;
  /** Axis of the view that is up: 0, 1 or 2, and which way. */
  readonly up: Vector3;
  readonly mirror: Matrix4;

  constructor(page: Page) {
    const { right, up, look } = page.scene.camera;
    this.hand = dot(right, cross(look, up)) < 0 ? -1 : 1;
    this.mirror = new Matrix4().makeScale(1, 1, this.hand);
    this.up = dominant(this.direction(up));
    this.bounds = this.around(page);
  }

  place(p: Vec3): Vector3 {
    return new Vector3(p[0], p[1], p[2] * this.hand);
  }

  direction(d: Vec3): Vector3 {
    return this.place(d).normalize();
  }

  /** The ball around what is seen: the scene's bounds if sensible, else the rays' ends. */
  private around(page: Page): Sphere {
    const box = new Box3();
    for (const corner of page.scene.bounds ?? []) box.expandByPoint(this.place(corner));
    const rays = new Box3();
    for (const node of page.trees[0]?.nodes ?? []) {
      rays.expandByPoint(this.place(node.origin));
      if (node.point) rays.expandByPoint(this.place(node.point));
    }
    const sphere = new Sphere();
    const near = rays.getBoundingSphere(new Sphere());
    if (box.isEmpty()) return near.radius > 0 ? near : new Sphere(new Vector3(), 1);
    box.union(rays);
    box.getBoundingSphere(sphere);
    // A floor that reaches to the horizon must not make all else a dot.
    const most = Math.max(near.radius * 6, 1e-6);
    return sphere.radius > most ? new Sphere(near.center, most) : sphere;
  }
}

function dominant(v: Vector3): Vector3 {
  const [x, y, z] = [Math.abs(v.x), Math.abs(v.y), Math.abs(v.z)];
  if (y >= x && y >= z) return new Vector3(0, Math.sign(v.y) || 1, 0);
  return z >= x ? new Vector3(0, 0, Math.sign(v.z) || 1) : new Vector3(Math.sign(v.x) || 1, 0, 0);
}
