// Duerer's machine in the scene: the eyelet in the wall is the eye, the frame is the picture, the string a ray; where
// the string goes through the frame a dot goes onto the paper, which is hinged to the frame.
import { BufferAttribute, BufferGeometry, CanvasTexture, DoubleSide, Group, Mesh, MeshBasicMaterial, Vector3 } from "three";

import type { Page } from "../data/types";
import { FatLines, type Line } from "./fatlines";
import type { Ghosts } from "./ghosts";
import type { Space } from "./space";
import { touch } from "./touch";

const WOOD: Line["color"] = [0.48, 0.31, 0.16];
const STRING: Line["color"] = [0.76, 0.52, 0.2];
const THREAD: Line["color"] = [0.62, 0.56, 0.46];

export class Machine {
  readonly group = new Group();
  private readonly lines = new FatLines({ casing: 1.2, rank: 40 });
  private readonly paper: HTMLCanvasElement;
  private readonly texture: CanvasTexture;
  private readonly eye: Vector3;
  private readonly right: Vector3;
  private readonly up: Vector3;
  private readonly look: Vector3;
  /** How far the frame is from the eye. */
  private readonly depth: number;
  private readonly half: [number, number];
  private picture: CanvasRenderingContext2D | null = null;
  private readonly dots = new Set<string>();

  constructor(private readonly page: Page, private readonly space: Space, private readonly ghosts: Ghosts) {
    const { camera } = page.scene;
    this.eye = space.place(camera.eye);
    [this.right, this.up, this.look] = [camera.right, camera.up, camera.look].map((d) => space.direction(d)) as [Vector3, Vector3, Vector3];
    const first = page.trees[0]!.nodes[0]!;
    const reach = first.t !== null ? space.length(first.t) : Math.max(this.eye.distanceTo(space.bounds.center), 0.5);
    this.depth = 0.34 * reach;
    const open = (degrees: number) => Math.tan((Math.min(Math.max(degrees, 5), 150) * Math.PI) / 360) * this.depth;
    this.half = [open(camera.fov_x), open(camera.fov_y)];
    this.paper = document.createElement("canvas");
    this.paper.width = 512;
    this.paper.height = Math.max(1, Math.round((512 * this.half[1]) / this.half[0]));
    this.texture = new CanvasTexture(this.paper);
    this.wipe();
    this.group.add(this.lines.group, this.sheet());
    this.group.visible = false;
    this.loadPicture();
  }

  /** Whether it stands where this page's eye is, before this page's picture. */
  fits(page: Page): boolean {
    return page.scene.camera === this.page.scene.camera && page.picture?.png === this.page.picture?.png;
  }

  dispose(): void {
    this.texture.dispose();
    this.group.removeFromParent();
  }

  /** Point of the frame for a place in the film, in pixels. */
  private onFrame([x, y]: [number, number]): Vector3 {
    const { width, height } = this.page.trees[0]!;
    const [sx, sy] = [(2 * x) / width - 1, 1 - (2 * y) / height];
    return this.eye.clone().addScaledVector(this.look, this.depth)
      .addScaledVector(this.right, sx * this.half[0]).addScaledVector(this.up, sy * this.half[1]);
  }

  /** The paper hangs open at the frame's left side. */
  private sheet(): Mesh {
    const { width, height } = this.page.trees[0]!;
    const [a, d] = [this.onFrame([0, 0]), this.onFrame([0, height])];
    const swing = this.right.clone().multiplyScalar(-0.85).addScaledVector(this.look, -0.5);
    const wide = this.onFrame([0, 0]).distanceTo(this.onFrame([width, 0]));
    const [b, c] = [a.clone().addScaledVector(swing, wide), d.clone().addScaledVector(swing, wide)];
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([a, b, c, d].flatMap((p) => p.toArray())), 3));
    // Shut it lies on the frame; hanging open it shows the picture from behind.
    geometry.setAttribute("uv", new BufferAttribute(new Float32Array([0, 1, 1, 1, 1, 0, 0, 0]), 2));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const mesh = new Mesh(geometry, new MeshBasicMaterial({ map: this.texture, side: DoubleSide, toneMapped: false }));
    mesh.renderOrder = 3;
    return mesh;
  }

  private loadPicture(): void {
    const found = this.page.picture;
    if (!found?.png.startsWith("data:image/")) return;
    const image = new Image();
    image.onload = () => {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [image.width, image.height];
      this.picture = canvas.getContext("2d", { willReadFrequently: true });
      this.picture?.drawImage(image, 0, 0);
    };
    image.src = found.png;
  }

  wipe(): void {
    this.dots.clear();
    const context = this.paper.getContext("2d")!;
    context.fillStyle = "#efe6d2";
    context.fillRect(0, 0, this.paper.width, this.paper.height);
    this.texture.needsUpdate = true;
  }

  /** A dot on the paper, in the colour that the picture has there. */
  dot([x, y]: [number, number]): void {
    const { width, height } = this.page.trees[0]!;
    const [u, v] = [x / width, y / height];
    const key = `${Math.round(u * 400)} ${Math.round(v * 400)}`;
    if (this.dots.has(key)) return;
    this.dots.add(key);
    const context = this.paper.getContext("2d")!;
    context.fillStyle = this.colorAt(u, v);
    context.beginPath();
    context.arc(u * this.paper.width, v * this.paper.height, 4.5, 0, 2 * Math.PI);
    context.fill();
    this.texture.needsUpdate = true;
  }

  private colorAt(u: number, v: number): string {
    if (!this.picture) return "#2b2118";
    const { width, height } = this.picture.canvas;
    const at = this.picture.getImageData(Math.min(width - 1, Math.floor(u * width)), Math.min(height - 1, Math.floor(v * height)), 1, 1);
    return `rgb(${at.data[0]} ${at.data[1]} ${at.data[2]})`;
  }

  /** Puts the string through a place in the film; says how far away it touches something, in metres. */
  aim(film: [number, number]): { touched: number | null } {
    const through = this.onFrame(film);
    const d = through.clone().sub(this.eye).normalize();
    const t = touch(this.ghosts, null, this.eye, d);
    const end = this.eye.clone().addScaledVector(d, t ?? this.space.bounds.radius * 2.2);
    this.lines.set([...this.frame(), ...this.eyelet(), ...this.threads(film), ...this.grid(film),
      line(this.eye, end, STRING, 2.6), line(end, end.clone().addScaledVector(d, -this.depth * 0.06), [0.9, 0.2, 0.1], 5)]);
    this.dot(film);
    return { touched: t === null ? null : this.space.metres(t) };
  }

  private frame(): Line[] {
    const { width, height } = this.page.trees[0]!;
    const c = ([[0, 0], [width, 0], [width, height], [0, height]] as [number, number][]).map((p) => this.onFrame(p));
    const legs = [c[2]!, c[3]!].map((p) => line(p, p.clone().addScaledVector(this.up, -this.half[1] * 0.5), WOOD, 5));
    return [...c.map((p, i) => line(p, c[(i + 1) % 4]!, WOOD, 6)), ...legs];
  }

  private eyelet(): Line[] {
    const r = this.depth * 0.03;
    const on = (i: number): Vector3 => this.eye.clone()
      .addScaledVector(this.right, r * Math.cos((i * Math.PI) / 8)).addScaledVector(this.up, r * Math.sin((i * Math.PI) / 8));
    const ring = Array.from({ length: 16 }, (_, i) => line(on(i), on(i + 1), WOOD, 3));
    const down = this.eye.clone().addScaledVector(this.up, -this.depth * 0.3);
    const weight = down.clone().addScaledVector(this.up, -this.depth * 0.05);
    return [...ring, line(this.eye, down, STRING, 1.6), line(down, weight, [0.3, 0.3, 0.32], 9)];
  }

  /** Two threads across the frame that meet where the string goes through. */
  private threads([x, y]: [number, number]): Line[] {
    const { width, height } = this.page.trees[0]!;
    return [
      line(this.onFrame([0, y]), this.onFrame([width, y]), THREAD, 1.4),
      line(this.onFrame([x, 0]), this.onFrame([x, height]), THREAD, 1.4),
    ];
  }

  /** The pixels around the string, and coarse lines over all. */
  private grid([x, y]: [number, number]): Line[] {
    const { width, height } = this.page.trees[0]!;
    const step = Math.max(1, Math.ceil(Math.max(width, height) / 24));
    const out: Line[] = [];
    const across = (p: [number, number], q: [number, number], alpha: number) =>
      out.push({ ...line(this.onFrame(p), this.onFrame(q), THREAD, 0.7), alpha });
    for (let i = step; i < width; i += step) across([i, 0], [i, height], 0.35);
    for (let j = step; j < height; j += step) across([0, j], [width, j], 0.35);
    if (step > 1) {
      const [cx, cy] = [Math.floor(x), Math.floor(y)];
      for (let i = -4; i <= 5; i++) {
        across([cx + i, cy - 4], [cx + i, cy + 5], 0.8);
        across([cx - 4, cy + i], [cx + 5, cy + i], 0.8);
      }
    }
    return out;
  }

  /** A view from behind the eyelet, from aside, that shows it all. */
  viewpoint(): { target: Vector3; direction: Vector3; distance: number } {
    const target = this.eye.clone().addScaledVector(this.look, this.depth * 1.3);
    const direction = this.look.clone().addScaledVector(this.right, -0.75).addScaledVector(this.space.up, -0.42).normalize();
    return { target, direction, distance: this.depth * 3.5 };
  }

  size(width: number, height: number): void {
    this.lines.size(width, height);
  }

  casing(color: Parameters<FatLines["casing"]>[0]): void {
    this.lines.casing(color);
  }
}

function line(a: Vector3, b: Vector3, color: Line["color"], width: number): Line {
  return { a, b, color, width, dash: 0, order: 0, alpha: 1 };
}
