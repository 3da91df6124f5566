// Many forms as one: their points are moved to where they are seen, so that one draw does for all.
import { BufferAttribute, BufferGeometry, LineSegments, Mesh, Vector3, type Material, type Matrix4 } from "three";

import { normalMatrix } from "./shape";

export class Baker {
  /** Points so far. */
  size = 0;
  private readonly positions: Float32Array[] = [];
  private readonly normals: Float32Array[] = [];
  private readonly inks: Uint8Array[] = [];

  /** Adds a form without an index, where a matrix puts it. Lines have neither normals nor ink. */
  add(form: BufferGeometry, place: Matrix4, ink: [number, number, number] | null): void {
    const position = form.getAttribute("position");
    const count = position.count;
    const to = new Float32Array(3 * count);
    const p = new Vector3();
    for (let i = 0; i < count; i++) p.fromBufferAttribute(position, i).applyMatrix4(place).toArray(to, 3 * i);
    this.positions.push(to);
    this.size += count;
    if (!ink) return;
    const [normal, turned] = [form.getAttribute("normal"), normalMatrix(place)];
    const normals = new Float32Array(3 * count);
    for (let i = 0; i < count; i++) turned(p.fromBufferAttribute(normal, i)).toArray(normals, 3 * i);
    this.normals.push(normals);
    const bytes = ink.map((x) => Math.round(255 * Math.min(Math.max(x, 0), 1)));
    this.inks.push(Uint8Array.from({ length: 3 * count }, (_, i) => bytes[i % 3]!));
  }

  mesh(material: Material): Mesh | null {
    if (this.size === 0) return null;
    const geometry = this.geometry();
    geometry.setAttribute("normal", new BufferAttribute(joined(this.normals, new Float32Array(3 * this.size)), 3));
    geometry.setAttribute("ink", new BufferAttribute(joined(this.inks, new Uint8Array(3 * this.size)), 3, true));
    return new Mesh(geometry, material);
  }

  lines(material: Material): LineSegments | null {
    return this.size === 0 ? null : new LineSegments(this.geometry(), material);
  }

  private geometry(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(joined(this.positions, new Float32Array(3 * this.size)), 3));
    return geometry;
  }
}

function joined<T extends Float32Array | Uint8Array>(parts: T[], all: T): T {
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
