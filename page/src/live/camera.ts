// The live picture's camera: orbit, pan, dolly, fly and turn, by numbers alone. Of right-handed and left-handed worlds.
import { cross, dot, length, plus, scaled, sub, unit } from "../data/vector";
import type { CameraState } from "./protocol";
import type { Vec3 } from "../data/types";

/** Unit vectors; `distance` is from the eye to what is turned around. */
export interface Pose { eye: Vec3; forward: Vec3; up: Vec3; distance: number }

/** What the camera is in: `up` of the world, and 1 if right-handed, -1 if left-handed. */
export interface World { up: Vec3; hand: 1 | -1; size: number }

/** Steepest view up or down, as the sine of the elevation: straight down there is no left and right. */
const STEEPEST = Math.sin((89 * Math.PI) / 180);

export function poseOf(camera: CameraState): Pose {
  const { eye, forward, up, distance } = camera;
  return { eye, forward, up, distance: distance > 0 && Number.isFinite(distance) ? distance : 1 };
}

/** The world as the scene tells of it; `size` is half of its diagonal. */
export function worldOf(camera: CameraState, sceneUp: Vec3, handedness: "right" | "left", bounds: [Vec3, Vec3] | null): World {
  const size = bounds ? length(sub(bounds[1], bounds[0])) / 2 : camera.distance;
  return { up: unit(sceneUp), hand: handedness === "left" ? -1 : 1, size: size > 0 && Number.isFinite(size) ? size : 1 };
}

/** To the right of the picture. */
export function rightOf(pose: Pose, world: World): Vec3 {
  const right = scaled(cross(pose.forward, pose.up), world.hand);
  return length(right) > 1e-9 ? unit(right) : unit(scaled(cross(pose.forward, anyAcross(pose.forward)), world.hand));
}

function anyAcross([x, y, z]: Vec3): Vec3 {
  return Math.abs(x) < 0.6 ? [1, 0, 0] : Math.abs(y) < 0.6 ? [0, 1, 0] : [0, 0, z > 0 ? 1 : -1];
}

/** Upright in the picture and perpendicular to the view. */
export function trueUp(pose: Pose, world: World): Vec3 {
  return unit(scaled(cross(rightOf(pose, world), pose.forward), world.hand));
}

/** Turns around an axis by radians. */
function turn(v: Vec3, axis: Vec3, angle: number): Vec3 {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return plus(plus(scaled(v, c), scaled(cross(axis, v), s)), scaled(axis, dot(axis, v) * (1 - c)));
}

/** The direction of view turned: to the right by `yaw`, up by `pitch`, in radians. Stays upright. */
function turned(pose: Pose, world: World, yaw: number, pitch: number): Vec3 {
  const { up } = world;
  const around = turn(pose.forward, up, -yaw * world.hand);
  const sine = Math.min(Math.max(dot(around, up), -1), 1);
  const level = sub(around, scaled(up, sine));
  // Straight up or down: level is where the top of the picture points, or away from it.
  const ahead = length(level) > 1e-6 ? unit(level) : unit(levelled(scaled(pose.up, sine > 0 ? -1 : 1), up));
  const limit = Math.asin(STEEPEST);
  const now = Math.asin(sine);
  const next = Math.min(Math.max(now + pitch, Math.min(-limit, now)), Math.max(limit, now));
  return unit(plus(scaled(ahead, Math.cos(next)), scaled(up, Math.sin(next))));
}

function levelled(v: Vec3, up: Vec3): Vec3 {
  const level = sub(v, scaled(up, dot(v, up)));
  return length(level) > 1e-6 ? level : anyAcross(up);
}

/** Around what is seen: drawn to the right by `dx` radians, down by `dy`; the eye goes the other way. */
export function orbit(pose: Pose, world: World, dx: number, dy: number): Pose {
  const pivot = plus(pose.eye, scaled(pose.forward, pose.distance));
  const forward = turned(pose, world, dx, -dy);
  return { eye: sub(pivot, scaled(forward, pose.distance)), forward, up: world.up, distance: pose.distance };
}

/** Turns the head: to the right, up. */
export function look(pose: Pose, world: World, right: number, up: number): Pose {
  return { ...pose, forward: turned(pose, world, right, up), up: world.up };
}

/** Shifts what is seen, to the right and down, by shares of the picture's height; `opening`: of the whole height, in degrees. */
export function pan(pose: Pose, world: World, dx: number, dy: number, opening: number): Pose {
  const span = 2 * Math.tan((Math.min(Math.max(opening, 1), 150) * Math.PI) / 360) * pose.distance;
  const side = scaled(rightOf(pose, world), -dx * span);
  return { ...pose, eye: plus(pose.eye, plus(side, scaled(trueUp(pose, world), dy * span))) };
}

/** Nearer to the pivot (below 1) or farther. */
export function dolly(pose: Pose, world: World, factor: number): Pose {
  const distance = Math.min(Math.max(pose.distance * factor, world.size * 1e-4), world.size * 100);
  return { ...pose, distance, eye: plus(pose.eye, scaled(pose.forward, pose.distance - distance)) };
}

/** Flies: along the view, to the right, up; in shares of a step that suits the scene. */
export function fly(pose: Pose, world: World, forward: number, right: number, up: number): Pose {
  const step = Math.max(Math.min(pose.distance, world.size), world.size * 0.02);
  const way = plus(plus(scaled(pose.forward, forward * step), scaled(rightOf(pose, world), right * step)), scaled(world.up, up * step));
  return { ...pose, eye: plus(pose.eye, way) };
}

/** What is turned around from now on lies as far as this. */
export function pivotAt(pose: Pose, distance: number): Pose {
  return distance > 0 && Number.isFinite(distance) ? { ...pose, distance } : pose;
}
