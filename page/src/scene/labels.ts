// Words over the 3D view, as text of the page: crisp at any size and read by screen readers if wanted.
import { Vector3, type PerspectiveCamera } from "three";

import type { Label } from "./marks";

export class Labels {
  private readonly pool: HTMLElement[] = [];

  constructor(private readonly layer: HTMLElement) {}

  /** Puts labels at their places; those behind the camera are hidden. */
  show(labels: Label[], camera: PerspectiveCamera, width: number, height: number): void {
    const taken: [number, number, number][] = [];
    labels.forEach((label, index) => {
      const element = (this.pool[index] ??= this.make());
      if (element.textContent !== label.text) element.textContent = label.text;
      element.className = `mark ${label.tone}`;
      const p = new Vector3().copy(label.at).project(camera);
      const [x, y] = [((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height];
      const outside = p.z > 1 || p.z < -1 || x < -40 || x > width + 40 || y < -20 || y > height + 20;
      // Where words would lie on each other the first one stays.
      const room = label.text.length * 4 + 8;
      const crowded = label.tone !== "strong" && taken.some(([tx, ty, tr]) => Math.abs(tx - x) < tr + room && Math.abs(ty - y) < 15);
      element.hidden = outside || crowded;
      if (element.hidden) return;
      taken.push([x, y, room]);
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
    });
    for (let i = labels.length; i < this.pool.length; i++) this.pool[i]!.hidden = true;
  }

  private make(): HTMLElement {
    const element = document.createElement("span");
    this.layer.append(element);
    return element;
  }
}
