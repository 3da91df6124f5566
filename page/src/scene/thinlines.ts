// Lines of one pixel: what a crowd of rays is drawn with while the view moves. One draw, and few pixels.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineSegments, ShaderMaterial } from "three";

import type { Line } from "./fatlines";

const VERTEX = /* glsl */ `
attribute vec4 ink;
attribute float order;
uniform float uStep;
varying vec4 vInk;
void main() {
  vInk = ink;
  vec4 p = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position = order > uStep ? vec4(2.0, 2.0, 2.0, 1.0) : p;
}`;

const FRAGMENT = /* glsl */ `
precision mediump float;
varying vec4 vInk;
void main() {
  gl_FragColor = vInk;
}`;

export class ThinLines {
  readonly lines: LineSegments;
  private readonly step = { value: 1e9 };
  private ink = new BufferAttribute(new Uint8Array(0), 4, true);

  constructor(rank: number) {
    const material = new ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { uStep: this.step }, transparent: true, depthWrite: false,
    });
    this.lines = new LineSegments(new BufferGeometry(), material);
    this.lines.frustumCulled = false;
    this.lines.renderOrder = rank;
    this.lines.visible = false;
  }

  set(lines: Line[]): void {
    const n = lines.length;
    const [position, ink, order] = [new Float32Array(6 * n), new Uint8Array(8 * n), new Float32Array(2 * n)];
    lines.forEach((line, i) => {
      line.a.toArray(position, 6 * i);
      line.b.toArray(position, 6 * i + 3);
      const color = line.color.map((x) => Math.round(255 * x));
      ink.set([...color, 255, ...color, line.fades ? 25 : 255], 8 * i);
      order.set([line.order, line.order], 2 * i);
    });
    const { geometry } = this.lines;
    geometry.dispose();
    this.ink = new BufferAttribute(ink, 4, true).setUsage(DynamicDrawUsage);
    geometry.setAttribute("position", new BufferAttribute(position, 3));
    geometry.setAttribute("ink", this.ink);
    geometry.setAttribute("order", new BufferAttribute(order, 1));
  }

  /** Changes how strongly each line is drawn. */
  fade(alphaOf: (index: number) => number, fades: (index: number) => boolean): void {
    const { array } = this.ink;
    for (let i = 0; i < array.length / 8; i++) {
      const alpha = 255 * alphaOf(i);
      array[8 * i + 3] = alpha;
      array[8 * i + 7] = fades(i) ? alpha * 0.1 : alpha;
    }
    this.ink.needsUpdate = true;
  }

  at(step: number): void {
    this.step.value = step;
  }
}
