// Where a ray meets the ghosts: for shadow rays, whose blocker's place is not recorded, and for the machine's string.
import { Matrix4, Raycaster, Vector3 } from "three";

import type { Ghosts } from "./ghosts";

const caster = new Raycaster();

/** Distance to the first ghost along a unit direction, or null. */
export function touch(ghosts: Ghosts, name: string | null, origin: Vector3, direction: Vector3, far = Infinity): number | null {
  caster.set(origin, direction);
  caster.near = 1e-5;
  caster.far = far;
  const hits = caster.intersectObjects(ghosts.named(name), false);
  return hits[0]?.distance ?? null;
}

/** The camera that looks along a direction from a place. */
export function lookAlong(at: Vector3, direction: Vector3, up: Vector3): Matrix4 {
  const safe = Math.abs(direction.dot(up)) > 0.999 ? new Vector3(up.y, up.z, up.x) : up;
  return new Matrix4().lookAt(at, at.clone().add(direction), safe);
}
