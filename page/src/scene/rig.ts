// The camera and the hands on it: orbit, pan, dolly, fly, and sitting on a ray.
import { PerspectiveCamera, Vector3 } from "three";

import type { Space } from "./space";
import { lookAlong } from "./touch";

interface Pose { target: Vector3; yaw: number; pitch: number; distance: number }

const SMOOTH_MS = 420;

export class Rig {
  readonly camera = new PerspectiveCamera(45, 1, 0.01, 1000);
  private pose: Pose;
  private from: Pose | null = null;
  private to: Pose | null = null;
  private began = 0;
  private readonly e1: Vector3;
  private readonly e2: Vector3;
  /** The ray that the camera sits on, and how far along. */
  private seat: { origin: Vector3; direction: Vector3; at: number; length: number } | null = null;

  constructor(private readonly space: Space, private readonly changed: () => void) {
    const up = space.up;
    this.e1 = Math.abs(up.y) > 0.5 ? new Vector3(0, 0, 1) : new Vector3(0, 1, 0);
    this.e2 = up.clone().cross(this.e1);
    this.pose = { target: space.bounds.center.clone(), yaw: 0.6, pitch: 0.4, distance: space.bounds.radius * 2.4 };
    this.apply();
  }

  /** Direction from the target to the camera. */
  private back({ yaw, pitch }: Pose): Vector3 {
    return new Vector3()
      .addScaledVector(this.e1, Math.cos(yaw) * Math.cos(pitch))
      .addScaledVector(this.e2, Math.sin(yaw) * Math.cos(pitch))
      .addScaledVector(this.space.up, Math.sin(pitch));
  }

  private apply(): void {
    const { camera, space } = this;
    if (this.seat) {
      const { origin, direction, at, length } = this.seat;
      const place = origin.clone().addScaledVector(direction, at * length);
      const lifted = place.clone().addScaledVector(space.up, 0.012 * length);
      camera.position.copy(lifted);
      camera.quaternion.setFromRotationMatrix(lookAlong(lifted, direction, space.up));
    } else {
      const back = this.back(this.pose);
      camera.position.copy(this.pose.target).addScaledVector(back, this.pose.distance);
      camera.quaternion.setFromRotationMatrix(lookAlong(camera.position, back.clone().negate(), space.up));
    }
    const reach = camera.position.distanceTo(space.bounds.center) + space.bounds.radius * 8;
    camera.near = Math.max(this.seat ? reach / 2e5 : this.pose.distance / 500, reach / 2e5);
    camera.far = reach;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    this.changed();
  }

  orbit(dx: number, dy: number): void {
    this.stop();
    this.pose.yaw -= dx;
    this.pose.pitch = Math.min(Math.max(this.pose.pitch + dy, -1.54), 1.54);
    this.apply();
  }

  /** Moves what is seen by shares of the picture's height. */
  pan(dx: number, dy: number): void {
    this.stop();
    const scale = 2 * Math.tan((this.camera.fov * Math.PI) / 360) * this.pose.distance;
    const e = this.camera.matrixWorld.elements;
    this.pose.target.addScaledVector(new Vector3(e[0], e[1], e[2]), -dx * scale);
    this.pose.target.addScaledVector(new Vector3(e[4], e[5], e[6]), dy * scale);
    this.apply();
  }

  dolly(factor: number): void {
    if (this.seat) {
      this.seat.at = Math.min(Math.max(this.seat.at - Math.log(factor) * 0.35, -0.2), 0.995);
      this.apply();
      return;
    }
    this.stop();
    const { radius } = this.space.bounds;
    this.pose.distance = Math.min(Math.max(this.pose.distance * factor, radius * 1e-3), radius * 20);
    this.apply();
  }

  /** Flies: along the view, sideways, up. In shares of the distance to the target. */
  fly(forward: number, side: number, up: number): void {
    this.stop();
    const e = this.camera.matrixWorld.elements;
    const step = Math.max(this.pose.distance, this.space.bounds.radius * 0.1);
    this.pose.target.addScaledVector(new Vector3(e[8], e[9], e[10]), -forward * step);
    this.pose.target.addScaledVector(new Vector3(e[0], e[1], e[2]), side * step);
    this.pose.target.addScaledVector(this.space.up, up * step);
    this.apply();
  }

  /** Goes so that the camera stands at a distance from a target and looks along a direction. */
  face(target: Vector3, direction: Vector3, distance: number, smooth = true): void {
    const back = direction.clone().normalize().negate();
    const pitch = Math.asin(Math.min(Math.max(back.dot(this.space.up), -1), 1));
    const yaw = Math.atan2(back.dot(this.e2), back.dot(this.e1));
    this.glide({ target: target.clone(), yaw, pitch: Math.min(Math.max(pitch, -1.54), 1.54), distance }, smooth);
  }

  /** Keeps the direction of view. */
  center(target: Vector3, distance: number): void {
    this.glide({ ...this.pose, target: target.clone(), distance }, true);
  }

  private glide(to: Pose, smooth: boolean): void {
    this.seat = null;
    if (!smooth || matchMedia("(prefers-reduced-motion: reduce)").matches) {
      this.stop();
      this.pose = to;
      this.apply();
      return;
    }
    // The short way round.
    const turn = to.yaw - this.pose.yaw;
    const yaw = this.pose.yaw + turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI));
    this.from = { ...this.pose, target: this.pose.target.clone() };
    this.to = { ...to, yaw };
    this.began = performance.now();
    this.changed();
  }

  private stop(): void {
    this.from = this.to = null;
  }

  /** Moves on while it glides; false when at rest. */
  tick(now: number): boolean {
    if (!this.from || !this.to) return false;
    const x = Math.min((now - this.began) / SMOOTH_MS, 1);
    const s = x * x * (3 - 2 * x);
    const mix = (a: number, b: number) => a + (b - a) * s;
    this.pose = {
      target: this.from.target.clone().lerp(this.to.target, s),
      yaw: mix(this.from.yaw, this.to.yaw),
      pitch: mix(this.from.pitch, this.to.pitch),
      distance: Math.exp(mix(Math.log(this.from.distance), Math.log(this.to.distance))),
    };
    if (x >= 1) this.stop();
    this.apply();
    return true;
  }

  sit(origin: Vector3, direction: Vector3, length: number): void {
    this.stop();
    this.seat = { origin, direction, length, at: 0 };
    this.apply();
  }

  stand(): void {
    this.seat = null;
    this.apply();
  }

  get sits(): boolean {
    return this.seat !== null;
  }

  /** World length of a pixel at a place. */
  pixel(at: Vector3, height: number): number {
    const depth = Math.max(at.distanceTo(this.camera.position), this.camera.near);
    return (2 * Math.tan((this.camera.fov * Math.PI) / 360) * depth) / height;
  }
}
