// The 3D view: puts the parts together and keeps them in step with the store. Draws only when something changed.
import { batch, effect } from "@preact/signals";
import { Color, Scene, Vector3, WebGLRenderer } from "three";

import { asksLight } from "../data/kinds";
import type { Store } from "../state/store";
import { wires } from "./boxes";
import { FatLines, type Line } from "./fatlines";
import { fateInk, rivalLines } from "./fates";
import { opening, standoff } from "./frame";
import { Ghosts } from "./ghosts";
import { Labels } from "./labels";
import { Machine } from "./machine";
import { hitOf, marks, type Label, type Marks } from "./marks";
import { Pace } from "./pace";
import { attach, nearest } from "./pointer";
import { ends, lines, type RayLine } from "./rays";
import { Rig } from "./rig";
import { Space } from "./space";
import { ThinLines } from "./thinlines";

export type Look = "eye" | "all" | "hit" | "plane" | "machine";

/** With more rays than these lines do without casing: it would cover what is behind, and costs time. */
const MANY = 3000;

/** Milliseconds without movement after which the view is at rest. */
const REST = 180;

/** Pixels of the circle around a marked hit. */
const MARK_RADIUS = 112;

export class Viewer {
  readonly space: Space;
  readonly ghosts: Ghosts;
  machine: Machine;
  private readonly rig: Rig;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly rays = new FatLines({ rank: 20 });
  /** The same rays while the view moves, if they are many. */
  private readonly thin = new ThinLines(20);
  private readonly crowd = new FatLines({ rank: 10, casing: 0, opacity: 0.4, arrows: false });
  private readonly rival = new FatLines({ rank: 14 });
  private readonly glow = new FatLines({ rank: 16, casing: 0, widen: 9, opacity: 0.55, arrows: false });
  private readonly boxes = new FatLines({ rank: 12, casing: 0, arrows: false });
  private readonly signs = new FatLines({ rank: 30, onTop: true });
  private readonly labels: Labels;
  private drawn: RayLine[] = [];
  private marked: Marks | null = null;
  private waiting = false;
  private grown = 1;
  private growBegan = 0;
  private size: [number, number] = [1, 1];
  private readonly pace = new Pace(() => this.resize());
  /** When the view moved last; it is at rest if that was long ago. */
  private movedAt = -Infinity;
  private resting: ReturnType<typeof setTimeout> | undefined;
  private frames = 0;
  private readonly kept: (() => void)[] = [];
  private readonly observer = new ResizeObserver(() => this.resize());
  private gone = false;

  constructor(private readonly canvas: HTMLCanvasElement, layer: HTMLElement, private readonly store: Store) {
    // Lines smooth their own edges; many of them would pay dearly for having it done again.
    const antialias = store.page.trees.every((tree) => tree.nodes.length <= MANY);
    this.renderer = new WebGLRenderer({ canvas, antialias, powerPreference: "high-performance" });
    this.space = new Space(store.page);
    this.ghosts = new Ghosts(store.page.scene, this.space);
    this.machine = new Machine(store.page, this.space, this.ghosts);
    this.rig = new Rig(this.space, () => this.moved());
    this.labels = new Labels(layer);
    this.scene.add(this.ghosts.group, this.machine.group);
    this.scene.add(this.thin.lines);
    for (const set of this.sets()) this.scene.add(set.group);
    attach(canvas, this.rig, {
      hover: (at) => (store.hovered.value = at && this.pick(at, 7)),
      click: (at) => this.click(at),
      moved: () => store.sitting.peek() && (store.sitting.value = false),
    });
    this.observer.observe(canvas);
    this.resize();
    this.follow();
    this.look("all", false);
  }

  /** Does it now and when what it read changes, as long as the view is there. */
  private keep(what: () => void): void {
    this.kept.push(effect(what));
  }

  /** Gives back what the graphics card holds. */
  dispose(): void {
    this.kept.forEach((stop) => stop());
    this.observer.disconnect();
    clearTimeout(this.resting);
    this.gone = true;
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private sets(): FatLines[] {
    return [this.crowd, this.rival, this.glow, this.boxes, this.rays, this.signs];
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.size = [width, height];
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2) * this.pace.density);
    this.renderer.setSize(width, height, false);
    [...this.sets(), this.machine].forEach((set) => set.size(width, height));
    this.rig.camera.aspect = width / height;
    this.fit();
    this.invalidate();
  }

  /** An opening that shows the whole picture of the scene's camera when seen through its eye. */
  private fit(): void {
    const { fov_x, fov_y } = this.store.page.scene.camera;
    const tan = (degrees: number) => Math.tan((Math.min(Math.max(degrees || 45, 10), 100) * Math.PI) / 360);
    const open = Math.max(tan(fov_y), tan(fov_x) / this.rig.camera.aspect) * 1.06;
    this.rig.camera.fov = (Math.atan(open) * 360) / Math.PI;
    this.rig.camera.updateProjectionMatrix();
  }

  /** What changes when the store does. */
  private follow(): void {
    const { store } = this;
    this.keep(() => this.recolor(store.dark.value));
    this.keep(() => this.rebuild());
    this.keep(() => this.emphasize());
    this.keep(() => this.advance(store.step.value));
    this.keep(() => {
      const walk = store.tab.value === "walk" ? store.node.value.walk : null;
      this.boxes.set(walk ? wires(walk, store.walkStep.value ?? walk.length - 1, this.space) : []);
      this.invalidate();
    });
    this.keep(() => {
      const node = store.node.value;
      if (!store.sitting.value) return this.rig.sits ? this.rig.stand() : undefined;
      const e = ends(node, this.space, this.ghosts);
      if (e) this.rig.sit(e.a, e.b.clone().sub(e.a).normalize(), e.a.distanceTo(e.b));
    });
    this.keep(() => {
      const on = store.machine.value;
      if (on && !this.machine.fits(store.page)) this.rebuildMachine();
      const turned = on !== this.machine.group.visible;
      this.machine.group.visible = on;
      if (on) {
        const at = store.machineAt.value ?? store.g.value.tree.film ?? store.g.value.tree.pixel.map((p) => p + 0.5) as [number, number];
        this.canvas.dataset["touched"] = String(this.machine.aim(at).touched ?? "");
      }
      if (turned) this.look(on ? "machine" : "all");
      this.invalidate();
    });
  }

  /** The eye has moved since, or the picture is another. */
  private rebuildMachine(): void {
    const { dark, page } = this.store;
    this.machine.dispose();
    this.machine = new Machine(page, this.space, this.ghosts);
    this.machine.size(...this.size);
    this.machine.casing(machineCasing(dark.peek()));
    this.scene.add(this.machine.group);
  }

  private recolor(dark: boolean): void {
    const ground = new Color(dark ? 0x15171b : 0xf3f0e9);
    this.scene.background = null;
    this.renderer.setClearColor(ground, 1);
    const casing = dark ? new Color(0.72, 0.74, 0.78) : new Color(0.16, 0.15, 0.14);
    // Dark blue needs light around it on dark ground, grey and green something dark on light ground.
    [this.rays, this.rival, this.signs].forEach((set) => set.casing(casing));
    this.signs.casing(dark ? new Color(0, 0, 0) : new Color(1, 1, 1));
    this.machine.casing(machineCasing(dark));
    this.ghosts.theme(dark);
    this.invalidate();
  }

  private rebuild(): void {
    const { store } = this;
    this.rays.lean(this.many());
    const style = { palette: store.palette.value, dark: store.dark.value };
    const comparing = store.tab.value === "compare" && store.rival.value !== null;
    const ink = comparing ? fateInk(store.pairs.value) : undefined;
    this.drawn = lines(store.g.value, store.plot.value, this.space, this.ghosts, { ...style, ...(ink && { ink }) });
    this.rays.set(this.drawn);
    this.thin.set(this.many() ? this.drawn : []);
    this.rival.set(comparing ? rivalLines(store.rival.value!, store.pairs.value, this.space, this.ghosts, style) : []);
    const others = store.bundle.value ? store.page.trees.map((_, i) => i).filter((i) => i !== store.treeIndex.value) : [];
    this.crowd.set(others.flatMap((i) => lines(store.groveOf(i), null, this.space, this.ghosts, { ...style, thin: 0.5 })));
    this.canvas.dataset["rays"] = String(this.drawn.length);
    this.advance(store.step.peek());
    this.emphasize();
  }

  /** The path to the selected ray is strong, the rest steps back. */
  private emphasize(): void {
    const { selected, hovered, path, machine, dark, palette, g } = this.store;
    const chosen = selected.value;
    const on = path.value;
    const few = g.value.nodes.length < 3;
    const rest = machine.value ? 0.12 : g.value.nodes.length > MANY ? 0.3 : 0.62;
    const strength = (i: number): number => (few || on.has(this.drawn[i]!.node) || g.value.nodes[this.drawn[i]!.node]!.parent === chosen ? 1 : rest);
    this.rays.fade(strength);
    this.thin.fade(strength, (i) => this.drawn[i]!.fades === true);
    const accent: [number, number, number] = dark.value ? [1, 0.84, 0.35] : [1, 0.72, 0.12];
    const glowing = machine.value ? [] : this.drawn.filter((line) => line.node === chosen || line.node === hovered.value);
    this.glow.set(glowing.map((line): Line => ({ ...line, color: accent, dash: 0, order: 0, alpha: line.node === chosen ? 1 : 0.6 })));
    this.marked = machine.value ? null : marks(g.value, this.store.node.value, this.space, palette.value, dark.value);
    this.signs.set(this.marked?.lines ?? []);
    if (this.marked) this.signs.group.position.copy(this.marked.at);
    this.canvas.dataset["selected"] = String(chosen);
    this.canvas.dataset["hovered"] = String(hovered.value ?? "");
    this.invalidate();
  }

  private advance(step: number | null): void {
    this.growBegan = performance.now();
    const pushes = step !== null && this.store.plot.peek().steps[step]?.act === "push";
    this.grown = pushes && !matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : 1;
    this.canvas.dataset["seen"] = String(new Set(this.drawn.filter((line) => step === null || line.order <= step).map((line) => line.node)).size);
    this.invalidate();
  }

  private pick(at: [number, number], reach: number): number | null {
    const step = this.store.step.value;
    return nearest(this.drawn, (line) => step === null || line.order <= step, this.rig, this.size, at, reach);
  }

  private click(at: [number, number]): void {
    const found = this.pick(at, 14);
    if (found !== null) batch(() => this.store.select(found));
  }

  /** Goes to a view. */
  look(what: Look, smooth = true): void {
    const { space, store, rig } = this;
    if (store.sitting.peek()) store.sitting.value = false;
    const { camera } = store.page.scene;
    const eye = space.place(camera.eye);
    const node = store.node.peek();
    const hit = hitOf(store.g.peek(), node);
    const at = hit?.point ? space.place(hit.point) : null;
    if (what === "machine") {
      const { target, direction, distance } = this.machine.viewpoint();
      rig.face(target, direction, distance, smooth);
    } else if (what === "eye") {
      const { t } = store.g.peek().nodes[0]!;
      const reach = t !== null ? space.length(t) : Math.max(eye.distanceTo(space.bounds.center), 0.5);
      const d = space.direction(camera.look);
      rig.face(eye.clone().addScaledVector(d, reach), d, reach, smooth);
    } else if (what === "all") {
      const d = space.direction(camera.look);
      const side = space.direction(camera.right);
      const direction = d.clone().multiplyScalar(0.75).addScaledVector(side, -0.75).addScaledVector(space.up, -0.5).normalize();
      const { center, radius } = this.ofRays();
      rig.face(center, direction, standoff(radius, rig.camera.fov, rig.camera.aspect), smooth);
    } else if (at && what === "hit") rig.center(at, this.span(node));
    else if (at && hit) {
      const n = space.direction(hit.normal ?? camera.up);
      const across = n.clone().cross(space.direction(hit.direction));
      if (across.lengthSq() < 1e-8) across.copy(n).cross(space.up);
      if (across.dot(rig.camera.position.clone().sub(at)) > 0) across.negate();
      rig.face(at, across.normalize(), this.span(node), smooth);
    }
  }

  /** The ball around what the rays touch. */
  private ofRays(): { center: Vector3; radius: number } {
    const nodes = this.store.g.peek().nodes.filter((node) => node.point && !asksLight(node));
    const hits = nodes.slice(0, 2000).map((node) => this.space.place(node.point!).toArray());
    const { center, radius } = opening(this.space.place(this.store.page.scene.camera.eye).toArray(), hits);
    return { center: new Vector3(...center), radius };
  }

  /** How far away a hit is looked at. */
  private span(node: { t: number | null }): number {
    const reach = node.t !== null ? this.space.length(node.t) : this.space.bounds.radius * 0.4;
    return Math.min(Math.max(reach * 1.2, this.space.bounds.radius * 0.15), this.space.bounds.radius * 1.5);
  }

  /** Keys that move the camera. */
  key(key: string): boolean {
    const moves: Record<string, () => void> = {
      w: () => this.rig.fly(0.06, 0, 0), s: () => this.rig.fly(-0.06, 0, 0), q: () => this.rig.fly(0, 0, 0.05), z: () => this.rig.fly(0, 0, -0.05),
      j: () => this.rig.orbit(0.09, 0), l: () => this.rig.orbit(-0.09, 0), i: () => this.rig.orbit(0, 0.07), k: () => this.rig.orbit(0, -0.07),
      "+": () => this.rig.dolly(0.88), "=": () => this.rig.dolly(0.88), "-": () => this.rig.dolly(1.14),
    };
    const move = moves[key];
    if (!move) return false;
    if (this.store.sitting.peek() && !"+=-".includes(key)) this.store.sitting.value = false;
    move();
    return true;
  }

  /** Takes away what lies nearer than a share of the scene, along an axis or the view. */
  section(axis: "none" | "x" | "y" | "z" | "view", share: number): void {
    if (axis === "none") this.ghosts.section(null);
    else {
      const n = axis === "view" ? this.rig.camera.position.clone().sub(this.space.bounds.center).normalize()
        : new Vector3(axis === "x" ? 1 : 0, axis === "y" ? 1 : 0, axis === "z" ? 1 : 0);
      const { center, radius } = this.space.bounds;
      this.ghosts.section(n, n.dot(center) + (share * 2 - 1) * radius);
    }
    this.invalidate();
  }

  private many(): boolean {
    return this.store.g.peek().nodes.length > MANY;
  }

  /** Draws, and draws again in full once the view is at rest. */
  private moved(): void {
    this.movedAt = performance.now();
    clearTimeout(this.resting);
    this.resting = setTimeout(() => this.invalidate(), REST + 20);
    this.invalidate();
  }

  invalidate(): void {
    if (this.waiting || this.gone) return;
    this.waiting = true;
    requestAnimationFrame((now) => this.frame(now));
  }

  private frame(now: number): void {
    this.waiting = false;
    if (this.gone) return;
    const moving = this.rig.tick(now);
    const time = Math.min(420, 700 / this.store.speed.peek());
    if (this.grown < 1) this.grown = Math.min((now - this.growBegan) / time, 1);
    const step = this.store.step.peek();
    this.rays.at(step ?? 1e9, Math.max(this.grown, 0));
    this.thin.at(step ?? 1e9);
    const quick = this.many() && now - this.movedAt < REST;
    this.thin.lines.visible = quick;
    this.rays.group.visible = !quick && this.drawn.length > 0;
    const [width, height] = this.size;
    if (this.marked) this.signs.group.scale.setScalar(this.rig.pixel(this.marked.at, height) * Math.min(MARK_RADIUS, height / 6));
    this.signs.group.visible = this.marked !== null && !this.rig.sits;
    this.renderer.render(this.scene, this.rig.camera);
    this.canvas.dataset["calls"] = String(this.renderer.info.render.calls);
    this.canvas.dataset["frames"] = String(++this.frames);
    this.pace.drawn(now);
    this.labels.show(this.labelled(), this.rig.camera, width, height);
    if (moving || this.grown < 1) this.invalidate();
  }

  private labelled(): Label[] {
    const { store } = this;
    const out: Label[] = [];
    const scale = this.signs.group.scale.x;
    if (this.marked && !this.rig.sits) {
      out.push(...this.marked.labels.map((l) => ({ ...l, at: l.at.clone().multiplyScalar(scale).add(this.marked!.at) })));
    }
    const chosen = this.drawn.find((line) => line.node === store.selected.peek());
    if (chosen && !store.machine.peek() && !this.rig.sits) {
      out.unshift({ text: store.g.peek().letters[chosen.node]!, at: chosen.a.clone().lerp(chosen.b, 0.45), tone: "strong" });
    }
    return out;
  }

  /** Frames per second while the camera turns once around; for measurements. */
  async turn(frames = 60): Promise<number> {
    const began = performance.now();
    for (let i = 0; i < frames; i++) {
      this.rig.orbit((2 * Math.PI) / frames, 0);
      await new Promise((done) => requestAnimationFrame(done));
      // The picture must be finished to count.
      this.renderer.getContext().finish();
    }
    return (1000 * frames) / (performance.now() - began);
  }
}

function machineCasing(dark: boolean): Color {
  return dark ? new Color(0, 0, 0) : new Color(1, 1, 1);
}
