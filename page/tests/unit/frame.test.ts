// What the 3D view opens with, whatever the size of the world and whatever was hit.
import { Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { asksLight } from "../../src/data/kinds";
import type { Page, SceneObject, Vec3 } from "../../src/data/types";
import { distance } from "../../src/data/vector";
import { around, opening, standoff, whole } from "../../src/scene/frame";
import { ends } from "../../src/scene/rays";
import { Rig } from "../../src/scene/rig";
import { Ghosts } from "../../src/scene/ghosts";
import { Space } from "../../src/scene/space";
import { page, tree } from "../support/synthetic";
import { missed, scaledPage } from "../support/scale";
import { whitted } from "../support/fixture";

const SIZES = [1e-18, 1e-6, 1, 1e6, 1e18];

/** The camera as the page opens, and the picture of places: all within -1..1 are seen. */
function opened(document: Page, aspect = 1.4) {
  const space = new Space(document);
  const rig = new Rig(space, () => {});
  rig.camera.aspect = aspect;
  rig.camera.updateProjectionMatrix();
  const { eye, look, right } = document.scene.camera;
  const hits = document.trees[0]!.nodes.filter((node) => node.point && !asksLight(node)).map((node) => space.place(node.point!).toArray());
  const ball = opening(space.place(eye).toArray(), hits);
  const direction = space.direction(look).multiplyScalar(0.75).addScaledVector(space.direction(right), -0.75).addScaledVector(space.up, -0.5).normalize();
  rig.face(new Vector3(...ball.center), direction, standoff(ball.radius, rig.camera.fov, aspect), false);
  return { space, rig, ball, seen: (p: Vec3) => space.place(p).project(rig.camera) };
}

function isSeen(p: Vector3): void {
  for (const x of p.toArray()) expect(Math.abs(x)).toBeLessThanOrEqual(1.0001);
}

describe("the ball around all that is seen", () => {
  it("is the same part of the world at every size", () => {
    const at = (s: number) => whole(scaledPage(whitted(), s));
    const one = at(1);
    for (const size of SIZES) {
      const ball = at(size);
      expect(ball.radius / size).toBeCloseTo(one.radius, 6);
      ball.center.forEach((x, i) => expect(x / size).toBeCloseTo(one.center[i]!, 6));
    }
  });

  it("makes numbers that graphics cards know", () => {
    for (const size of SIZES) {
      const document = scaledPage(whitted(), size);
      const space = new Space(document);
      const ghosts = new Ghosts(document.scene, space);
      for (const node of document.trees[0]!.nodes) {
        const line = ends(node, space, ghosts);
        for (const x of line ? [...line.a.toArray(), ...line.b.toArray()] : []) expect(Math.abs(x)).toBeLessThan(100);
        if (line && node.t !== null && node.point) expect(line.a.distanceTo(line.b)).toBeGreaterThan(1e-7);
      }
      expect(ghosts.group.children.length).toBeGreaterThan(0);
    }
  });

  it("holds the eye and the scene where nothing is hit", () => {
    const document = missed(whitted(), [0, 1, 0]);
    const ball = whole(document);
    for (const p of [document.scene.camera.eye, ...document.scene.bounds!]) expect(distance(p, ball.center)).toBeLessThanOrEqual(ball.radius * 1.0001);
  });

  it("is not that of a floor to the horizon where nothing is hit", () => {
    const small: SceneObject = { name: "ball", material: null, color: [1, 1, 1], emits: false, mesh: null, sphere: { center: [0, 0, 4], radius: 1 } };
    const floor: SceneObject = { ...small, name: "planet", sphere: { center: [0, -6e6, 0], radius: 6e6 } };
    const document = missed(page([tree(5)]), [0, 1, 0]);
    const ball = whole({ ...document, scene: { ...document.scene, bounds: [[-6e6, -1.2e7, -6e6], [6e6, 1, 6e6]], objects: [small, small, floor] } });
    expect(ball.radius).toBeLessThan(100);
    expect(ball.radius).toBeGreaterThan(5);
  });

  it("of an endless plane under a sky reaches down to the plane", () => {
    for (const size of SIZES) {
      const document = scaledPage(planeAndSky(), size);
      for (const hit of [true, false]) {
        const shown = hit ? document : missed(document, [0, 0.6, 0.8]);
        const ball = whole(shown);
        const eye = shown.scene.camera.eye;
        expect(distance(eye, ball.center)).toBeLessThanOrEqual(ball.radius);
        expect(ball.radius / size).toBeGreaterThan(1.5);
        expect(ball.radius / size).toBeLessThan(60);
        const space = new Space(shown);
        const ghosts = new Ghosts(shown.scene, space);
        const [sheet] = ghosts.named("floor");
        sheet!.geometry.computeBoundingSphere();
        const { center, radius } = sheet!.geometry.boundingSphere!;
        // The part of it that is drawn lies below the eye, and fills what is seen.
        expect(center.length()).toBeLessThan(1);
        expect(radius).toBeGreaterThan(2);
      }
    }
  });

  it("is one metre around the eye where there is nothing at all", () => {
    const document = missed(page([tree(5)]), [0, 0, 1]);
    const ball = whole({ ...document, scene: { ...document.scene, bounds: [[0, 0, 0], [0, 0, 0]], objects: [] } });
    expect(ball).toEqual({ center: [0, 1, -6], radius: 1 });
  });

  it("minds no place that is none", () => {
    const document = whitted();
    const [first] = document.trees;
    const broken = { ...first!.nodes[1]!, origin: [null, 0, NaN] as unknown as Vec3, point: [Infinity, 0, 0] as Vec3 };
    const ball = whole({ ...document, trees: [{ ...first!, nodes: [first!.nodes[0]!, broken, ...first!.nodes.slice(2)] }] });
    expect(Number.isFinite(ball.radius) && ball.center.every(Number.isFinite)).toBe(true);
    expect(around([[1e18, 0, 0], [1e18 + 128, 0, 0]])).toBeNull();
  });
});

describe("the opening view", () => {
  for (const size of SIZES) {
    it(`of a world of size ${size} shows the eye and every hit`, () => {
      for (const aspect of [0.46, 1.4, 2]) {
        const document = scaledPage(whitted(), size);
        const { seen, rig } = opened(document, aspect);
        isSeen(seen(document.scene.camera.eye));
        document.trees[0]!.nodes.forEach((node) => node.point && !asksLight(node) && isSeen(seen(node.point)));
        expect(rig.camera.near).toBeGreaterThan(1e-6);
        expect(rig.camera.far).toBeLessThan(1e4);
      }
    });

    it(`of a world of size ${size} shows the scene and the eye if the eye ray meets nothing`, () => {
      const document = scaledPage(missed(whitted(), [0, 1, 0]), size);
      const { seen, space, ball } = opened(document);
      isSeen(seen(document.scene.camera.eye));
      const [low, high] = document.scene.bounds!;
      isSeen(seen(low.map((x, i) => (x + high[i]!) / 2) as Vec3));
      // The line of the ray is long enough to be seen.
      const line = ends(document.trees[0]!.nodes[0]!, space, new Ghosts(document.scene, space))!;
      expect(line.a.distanceTo(line.b)).toBeGreaterThan(0.05 * ball.radius);
    });
  }
});

/** An eye at a height of 2 above a floor without end, under a sky. */
function planeAndSky(): Page {
  const document = page([tree(5)]);
  const words = (list: number[]) => Buffer.from(new Uint16Array(list).buffer).toString("base64");
  const floor: SceneObject = {
    name: "floor", material: null, color: [0.5, 0.5, 0.5], emits: false, plane: true,
    mesh: {
      origin: [-5, 0, -5], scale: 10 / 65535, wide: false, indices: words([0, 1, 2, 0, 2, 3]),
      positions: words([0, 0, 0, 65535, 0, 0, 65535, 0, 65535, 0, 0, 65535]),
    },
  };
  const eye: Vec3 = [0, 2, 0];
  const direction: Vec3 = [0, -0.6, 0.8];
  const ray = { ...document.trees[0]!.nodes[0]!, origin: eye, direction, t: 2 / 0.6, point: [0, 0, 8 / 3] as Vec3, object: "floor" };
  const scene = { ...document.scene, bounds: [[0, 0, 0], [0, 0, 0]] as [Vec3, Vec3], objects: [floor], camera: { ...document.scene.camera, eye } };
  return { ...document, scene, trees: [{ ...document.trees[0]!, nodes: [ray] }] };
}
