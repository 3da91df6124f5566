// Lines of any width with dashes, a casing that keeps them apart from the ground, and arrow heads: one draw for all.
// three's Line2 has one width and one dash pattern per draw; here both belong to the line, and the playback hides
// lines in the vertex shader, so that a step touches no buffer.
import {
  BufferAttribute, Color, DynamicDrawUsage, Group, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, NormalBlending,
  ShaderMaterial, Vector2, type Vector3,
} from "three";

export interface Line {
  a: Vector3;
  b: Vector3;
  color: [number, number, number];
  /** Pixels. */
  width: number;
  dash: number;
  /** Step of the playback from which on it is seen. */
  order: number;
  alpha: number;
  arrow?: boolean;
  /** Vanishes towards its end. */
  fades?: boolean;
}

const VERTEX = /* glsl */ `
attribute vec3 iA;
attribute vec3 iB;
attribute vec3 iColor;
attribute vec4 iStyle; // width, dash, order, arrow + 2 x fades
attribute float iAlpha;
uniform vec2 uSize;
uniform float uStep;
uniform float uGrow;
uniform float uCasing;
uniform float uWiden;
varying vec3 vColor;
varying float vAlpha;
varying vec4 vLine; // side, half width, along x w, w
varying vec2 vDash; // dash, length in pixels
varying float vFade;

void main() {
  vColor = iColor;
  vAlpha = iAlpha;
  float order = iStyle.z;
  vec3 to = order == uStep ? mix(iA, iB, uGrow) : iB;
  vec4 va = modelViewMatrix * vec4(iA, 1.0);
  vec4 vb = modelViewMatrix * vec4(to, 1.0);
  float near = -1.0001 * projectionMatrix[3][2] / (projectionMatrix[2][2] - 1.0);
  bool hidden = order > uStep || iAlpha <= 0.0 || (va.z > near && vb.z > near);
  if (va.z > near) va = mix(vb, va, (near - vb.z) / (va.z - vb.z));
  else if (vb.z > near) vb = mix(va, vb, (near - va.z) / (vb.z - va.z));
  vec4 a = projectionMatrix * va;
  vec4 b = projectionMatrix * vb;
  vec2 sa = a.xy / a.w * uSize * 0.5;
  vec2 sb = b.xy / b.w * uSize * 0.5;
  vec2 way = sb - sa;
  float len = length(way);
  way = len > 1e-4 ? way / len : vec2(1.0, 0.0);
  vec2 side = vec2(-way.y, way.x);
  float width = iStyle.x + uWiden;
#ifdef ARROW
  float size = 5.0 + 1.6 * width;
  bool arrow = mod(iStyle.w, 2.0) > 0.5;
  hidden = hidden || !arrow || len < 3.0 * size;
  vec4 p = mix(a, b, 0.58 * a.w / mix(b.w, a.w, 0.58));
  vec2 offset = way * position.x * size + side * position.y * size * 0.55;
  vLine = vec4(0.0, 1.0, 0.0, 1.0);
  vDash = vec2(0.0, 1.0);
  vFade = 1.0;
#else
  float half_ = width * 0.5 + uCasing + 1.0;
  vec4 p = position.x < 0.5 ? a : b;
  vec2 offset = side * position.y * half_;
  vLine = vec4(position.y * half_ * p.w, width * 0.5, position.x * len * p.w, p.w);
  vDash = vec2(iStyle.y, len);
  vFade = iStyle.w >= 1.5 ? 1.0 - 0.9 * position.x : 1.0;
#endif
  p.xy += offset / uSize * 2.0 * p.w;
  gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : p;
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
uniform vec3 uCasingColor;
uniform float uCasing;
uniform float uOpacity;
varying vec3 vColor;
varying float vAlpha;
varying vec4 vLine;
varying vec2 vDash;
varying float vFade;

float ink(float along) {
  if (vDash.x < 0.5) return 1.0;
  float unit = max(vLine.y * 2.0, 1.5);
  if (vDash.x < 1.5) return step(mod(along, unit * 5.0), unit * 3.2);
  if (vDash.x < 2.5) return step(mod(along, unit * 2.6), unit * 1.2);
  if (vDash.x < 3.5) return step(mod(along, unit * 9.0), unit * 7.0);
  float at = mod(along, unit * 9.0);
  return at < unit * 5.0 || (at > unit * 6.4 && at < unit * 7.6) ? 1.0 : 0.0;
}

void main() {
#ifdef ARROW
  gl_FragColor = vec4(vColor, vAlpha * uOpacity);
#else
  float off = abs(vLine.x / vLine.w);
  float core = clamp(vLine.y + 0.5 - off, 0.0, 1.0);
  float casing = clamp(vLine.y + uCasing + 0.5 - off, 0.0, 1.0);
  float drawn = ink(vLine.z / vLine.w);
  vec3 color = mix(uCasingColor, vColor, core);
  float alpha = max(core, casing * 0.55) * drawn * vAlpha * vFade * uOpacity;
  if (alpha < 0.004) discard;
  gl_FragColor = vec4(color, alpha);
#endif
}`;

/** A set of lines that is drawn at once. */
export class FatLines {
  readonly group = new Group();
  private readonly uniforms = {
    uSize: { value: new Vector2(1, 1) },
    uStep: { value: 1e9 },
    uGrow: { value: 1 },
    uCasing: { value: 1 },
    uCasingColor: { value: new Color(1, 1, 1) },
    uOpacity: { value: 1 },
    uWiden: { value: 0 },
  };
  private readonly usualCasing: number;
  private readonly body = new InstancedBufferGeometry();
  private readonly heads = new InstancedBufferGeometry();
  private alphas = new InstancedBufferAttribute(new Float32Array(0), 1);
  private colors = new InstancedBufferAttribute(new Float32Array(0), 3);

  constructor(options: { casing?: number; widen?: number; opacity?: number; onTop?: boolean; arrows?: boolean; rank?: number } = {}) {
    this.usualCasing = options.casing ?? 1;
    this.uniforms.uCasing.value = this.usualCasing;
    this.uniforms.uWiden.value = options.widen ?? 0;
    this.uniforms.uOpacity.value = options.opacity ?? 1;
    this.body.setAttribute("position", new BufferAttribute(new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]), 3));
    this.body.setIndex([0, 1, 2, 0, 2, 3]);
    this.heads.setAttribute("position", new BufferAttribute(new Float32Array([1, 0, 0, -0.8, 1, 0, -0.8, -1, 0]), 3));
    this.heads.setIndex([0, 1, 2]);
    const parts = options.arrows === false ? [this.body] : [this.body, this.heads];
    parts.forEach((geometry, index) => {
      const material = new ShaderMaterial({
        vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: this.uniforms, transparent: true, depthWrite: false,
        depthTest: !options.onTop, blending: NormalBlending, side: 2, ...(index === 1 && { defines: { ARROW: 1 } }),
      });
      const mesh = new Mesh(geometry, material);
      mesh.frustumCulled = false;
      mesh.renderOrder = (options.rank ?? 10) + index;
      this.group.add(mesh);
    });
    this.set([]);
  }

  set(lines: Line[]): void {
    const n = lines.length;
    const [a, b, color] = [new Float32Array(3 * n), new Float32Array(3 * n), new Float32Array(3 * n)];
    const [style, alpha] = [new Float32Array(4 * n), new Float32Array(n)];
    lines.forEach((line, i) => {
      line.a.toArray(a, 3 * i);
      line.b.toArray(b, 3 * i);
      color.set(line.color, 3 * i);
      style.set([line.width, line.dash, line.order, (line.arrow ? 1 : 0) + (line.fades ? 2 : 0)], 4 * i);
      alpha[i] = line.alpha;
    });
    this.alphas = new InstancedBufferAttribute(alpha, 1).setUsage(DynamicDrawUsage);
    this.colors = new InstancedBufferAttribute(color, 3).setUsage(DynamicDrawUsage);
    for (const geometry of [this.body, this.heads]) {
      geometry.dispose();
      geometry.setAttribute("iA", new InstancedBufferAttribute(a, 3));
      geometry.setAttribute("iB", new InstancedBufferAttribute(b, 3));
      geometry.setAttribute("iColor", this.colors);
      geometry.setAttribute("iStyle", new InstancedBufferAttribute(style, 4));
      geometry.setAttribute("iAlpha", this.alphas);
      geometry.instanceCount = n;
    }
    this.group.visible = n > 0;
  }

  /** Changes how strongly each line is drawn. */
  fade(alphaOf: (index: number) => number): void {
    const array = this.alphas.array as Float32Array;
    for (let i = 0; i < array.length; i++) array[i] = alphaOf(i);
    this.alphas.needsUpdate = true;
  }

  /** Shows what is seen at this step; `grow` is how much of the last line is drawn. */
  at(step: number, grow: number): void {
    this.uniforms.uStep.value = step;
    this.uniforms.uGrow.value = grow;
  }

  size(width: number, height: number): void {
    this.uniforms.uSize.value.set(width, height);
  }

  /** Without casing. */
  lean(on: boolean): void {
    this.uniforms.uCasing.value = on ? 0 : this.usualCasing;
  }

  casing(color: Color): void {
    this.uniforms.uCasingColor.value.copy(color);
  }
}
