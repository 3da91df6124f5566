// A stand-in for `durer view`: the protocol with a scene of balls on a floor that it draws itself, and recorded rays.
import { randomBytes } from "node:crypto";
import { existsSync, readFileSync } from "node:fs";
import { createServer, type IncomingMessage } from "node:http";
import type { AddressInfo, Socket } from "node:net";
import { join } from "node:path";

import { dot, length, plus, scaled, sub, unit } from "../../src/data/vector";
import type { Page, Vec3 } from "../../src/data/types";
import type { Form, Param, Value } from "../../src/live/protocol";
import { mockForms } from "./mockForms";
import { png } from "./png";
import { Peer } from "./websocket";

const BUILT = join(import.meta.dirname ?? __dirname, "../../dist/view.html");
const FILM: [number, number] = [320, 180];
const OF = 8;

interface Session { forms: Form[]; camera: { eye: Vec3; forward: Vec3; up: Vec3; exact: boolean }; seq: number; layer: string; samples: number; peer: Peer | null; paused: boolean; drawn: number }
type Message = Record<string, unknown> & { type: string };

const LAYERS = ["beauty", "depth", "normal", "shading", "albedo", "uv", "id", "cost"];
const home = (): Session["camera"] => ({ eye: [0, 1.2, 5], forward: unit([0, -0.15, -1]), up: [0, 1, 0], exact: true });

export class Mock {
  readonly token = randomBytes(8).toString("hex");
  /** All that the pages said, but for acknowledgements. */
  readonly heard: Message[] = [];
  readonly acks: number[] = [];
  address = "";
  /** What comes instead of answers to `set`, if anything. */
  refuse: { message: string; hint: string } | null = null;
  private revision = 1;
  private readonly sessions = new Map<string, Session>();
  private readonly server = createServer((request, answer) => {
    const url = new URL(request.url ?? "/", "http://localhost");
    if (url.pathname === "/save") {
      if (url.searchParams.get("format") === "pbrt") return void answer.writeHead(409, { "content-type": "text/plain" }).end("pbrt has no word for a mock\n");
      return void answer.writeHead(200, { "content-disposition": 'attachment; filename="mock.png"' }).end(png(2, 2, () => [9, 9, 9]));
    }
    if (url.pathname !== "/" || url.searchParams.get("token") !== this.token) return void answer.writeHead(403).end("no");
    const nonce = randomBytes(12).toString("hex");
    const policy = `default-src 'none'; script-src 'nonce-${nonce}'; style-src 'nonce-${nonce}'; img-src 'self' data: blob:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'`;
    if (!existsSync(BUILT)) throw new Error("page/dist/view.html is missing: npm run build");
    answer.writeHead(200, { "content-type": "text/html", "content-security-policy": policy }).end(readFileSync(BUILT, "utf8").replaceAll("__DURER_NONCE__", nonce));
  });

  constructor(private readonly rays: Page) {}

  async start(port = 0): Promise<this> {
    this.server.on("upgrade", (request, socket: Socket) => this.join(request, socket));
    await new Promise<void>((done) => this.server.listen(port, "127.0.0.1", done));
    this.address = `http://127.0.0.1:${(this.server.address() as AddressInfo).port}/?token=${this.token}`;
    return this;
  }

  stop(): void {
    this.cut();
    this.server.close();
    this.server.closeAllConnections();
  }

  /** Breaks all connections, as sleep does. */
  cut(code = 1006): void {
    for (const session of this.sessions.values()) {
      if (code === 1006) session.peer?.close(1001);
      else session.peer?.close(code);
      session.peer = null;
    }
  }

  /** The sessions die too, as if the program was started anew. */
  forget(): void {
    this.cut();
    this.sessions.clear();
  }

  reload(name: string): void {
    this.revision += 1;
    for (const session of this.sessions.values()) {
      session.peer?.say({ type: "scene", scene: this.scene(name), camera: this.camera(session), forms: session.forms });
      this.restart(session);
    }
  }

  fail(message: string | null): void {
    for (const { peer } of this.sessions.values()) peer?.say({ ...this.status(0), type: "status", state: message ? "error" : "rendering", message });
  }

  get viewers(): number {
    return [...this.sessions.values()].filter(({ peer }) => peer).length;
  }

  private join(request: IncomingMessage, socket: Socket): void {
    const url = new URL(request.url ?? "/", "http://localhost");
    if (url.pathname !== "/socket" || url.searchParams.get("token") !== this.token) return void socket.end("HTTP/1.1 403 Forbidden\r\n\r\n");
    const peer = new Peer(request, socket);
    const asked = url.searchParams.get("session") ?? "";
    const old = this.sessions.get(asked);
    old?.peer?.close(1008);
    const from = this.sessions.get(url.searchParams.get("from") ?? "");
    const id = old ? asked : randomBytes(6).toString("hex");
    const session: Session = old ?? { forms: structuredClone(from?.forms ?? mockForms()), camera: structuredClone(from?.camera ?? home()), seq: 0, layer: "beauty", samples: 0, peer, paused: false, drawn: 0 };
    session.peer = peer;
    session.seq = 0;
    this.sessions.set(id, session);
    peer.onMessage = (text) => this.hear(session, JSON.parse(text) as Message);
    peer.onEnd = () => {
      if (session.peer === peer) session.peer = null;
    };
    peer.say({
      type: "hello", version: 1, durer: "0.0.0", session: id, resumed: old !== undefined, scene: this.scene("balls"), camera: this.camera(session),
      layer: session.layer, layers: LAYERS, forms: session.forms, status: this.status(0),
    });
    this.restart(session);
  }

  private scene(name: string): object {
    return {
      name, revision: this.revision, triangles: 1234, objects: 3, bounds: [[-3, -1, -3], [3, 1, 3]], handedness: "right", up: [0, 1, 0],
      cameras: ["main", "top"], textures: [{ name: "wood", value: "color" }, { name: "grain", value: "float" }], time: [0, 2], warnings: ["a warning"],
    };
  }

  private camera({ camera: { eye, forward, up, exact } }: Session): object {
    return { name: exact ? "main" : null, kind: "perspective", eye, forward, up, right: [1, 0, 0], fov: [60, 36], distance: length(eye), exact };
  }

  private status(samples: number): object {
    return { state: samples >= OF ? "done" : "rendering", message: null, samples, of: OF, rays_per_s: 2.1e6, seconds: samples / 10, viewers: this.viewers };
  }

  private restart(session: Session): void {
    session.samples = -3;
    if (session.peer) this.draw(session, session.peer);
  }

  /** One frame; the next comes when it is acknowledged. */
  private draw(session: Session, peer: Peer): void {
    const coarse = session.samples < 0 ? 2 ** -session.samples : 1;
    const [width, height] = [Math.ceil(FILM[0] / coarse), Math.ceil(FILM[1] / coarse)];
    const samples = Math.max(session.samples + 1, 0);
    const done = samples >= OF;
    session.drawn = this.frame += 1;
    const header = Buffer.from(JSON.stringify({
      frame: this.frame, seq: session.seq, revision: this.revision, layer: session.layer, film: FILM, width, height, samples: coarse > 1 ? 0 : samples, of: OF, done,
      ms: 20 * (session.samples + 4), rays_per_s: 2.1e6, white: session.layer === "cost" ? 40 : null, range: session.layer === "depth" ? [3.1, 9] : null,
    }));
    const size = Buffer.alloc(4);
    size.writeUInt32LE(header.length);
    peer.bytes(Buffer.concat([size, header, png(width, height, (x, y) => this.shade(session, (x + 0.5) / width, (y + 0.5) / height, samples))]));
    peer.say({ type: "status", ...this.status(samples) });
  }
  private frame = 0;

  /** The next frame, unless another picture began meanwhile. */
  private next(session: Session, peer: Peer, after: number): void {
    if (session.peer !== peer || session.drawn !== after) return;
    session.samples += 1;
    this.draw(session, peer);
  }

  /** Balls on a floor; the noise lessens. */
  private shade({ camera: { eye, forward, up }, layer, forms }: Session, u: number, v: number, samples: number): [number, number, number] {
    const right = unit([forward[1] * up[2] - forward[2] * up[1], forward[2] * up[0] - forward[0] * up[2], forward[0] * up[1] - forward[1] * up[0]]);
    const top: Vec3 = [right[1] * forward[2] - right[2] * forward[1], right[2] * forward[0] - right[0] * forward[2], right[0] * forward[1] - right[1] * forward[0]];
    const d = unit(plus(forward, plus(scaled(right, (2 * u - 1) * 0.58), scaled(top, (1 - 2 * v) * 0.325))));
    let [t, color, normal]: [number, Vec3, Vec3] = [Infinity, [150, 180, 225], [0, 0, 0]];
    const given = forms.find(({ id }) => id === "material/0")!.params[0]!.value;
    const red = Array.isArray(given) ? (given as number[]) : [0.8, 0.1, 0.1];
    ([[[0, 0, 0], red.map((c) => 230 * c)], [[1.8, -0.3, -0.6], [70, 150, 90]], [[-1.7, -0.2, 0.4], [210, 190, 90]]] as [Vec3, Vec3][]).forEach(([center, c], i) => {
      const r = [1, 0.7, 0.8][i]!;
      const o = sub(eye, center);
      const b = dot(o, d);
      const root = b * b - dot(o, o) + r * r;
      const at = -b - Math.sqrt(Math.max(root, 0));
      if (root > 0 && at > 0 && at < t) [t, color, normal] = [at, c, unit(sub(plus(eye, scaled(d, at)), center))];
    });
    const floor = (-1 - eye[1]) / d[1];
    if (floor > 0 && floor < t) {
      const [x, , z] = plus(eye, scaled(d, floor));
      [t, normal] = [floor, [0, 1, 0]];
      color = (Math.floor(x) + Math.floor(z)) & 1 ? [190, 185, 175] : [110, 105, 100];
    }
    if (layer === "depth") return t === Infinity ? [0, 0, 0] : [255 - t * 20, 255 - t * 20, 255 - t * 20];
    if (layer === "normal") return normal.map((x) => 127 * (x + 1)) as Vec3;
    if (layer === "cost") return [20 + 200 * u, 20 + 60 * v, 20];
    const noise = ((Math.abs(Math.sin(u * 9177 + v * 5531 + samples)) * 60) - 30) / Math.sqrt(Math.max(samples, 1));
    const light = t === Infinity ? 1 : 0.35 + 0.65 * Math.max(0, dot(normal, unit([0.5, 0.8, 0.4])));
    return color.map((c) => c * light + noise) as Vec3;
  }

  private hear(session: Session, message: Message): void {
    const peer = session.peer;
    if (!peer) return;
    if (message.type === "ack") {
      this.acks.push(message["frame"] as number);
      if (message["frame"] === session.drawn && session.samples < OF - 1 && !session.paused) setTimeout(() => this.next(session, peer, session.drawn), 15);
      return;
    }
    this.heard.push(message);
    const form = session.forms.find(({ id }) => id === message["form"]);
    switch (message.type) {
      case "camera":
        session.seq = message["seq"] as number;
        session.camera = "eye" in message ? { eye: message["eye"] as Vec3, forward: message["forward"] as Vec3, up: message["up"] as Vec3, exact: false } : home();
        if (!("eye" in message)) peer.say({ type: "camera", ...this.camera(session) });
        return this.restart(session);
      case "set": {
        if (this.refuse) return peer.say({ type: "error", about: form!.id, param: message["param"], ...this.refuse, id: null }), peer.say({ type: "forms", forms: [form] });
        const param = form!.params.find(({ name }) => name === message["param"])!;
        [param.value, form!.changed] = [message["value"] as Value | null, true];
        return this.changed(session, form!);
      }
      case "kind": [form!.kind, form!.changed] = [message["kind"] as string, true]; return this.changed(session, form!);
      case "reset":
        session.forms = mockForms().map((fresh) => (form && form.id !== fresh.id ? session.forms.find(({ id }) => id === fresh.id)! : fresh));
        peer.say({ type: "forms", forms: session.forms });
        return this.restart(session);
      case "layer": session.layer = message["layer"] as string; return this.restart(session);
      case "pause": session.paused = message["paused"] as boolean; return session.paused ? undefined : this.restart(session);
      default: return this.answer(session, peer, message);
    }
  }

  private changed(session: Session, form: Form): void {
    session.peer?.say({ type: "forms", forms: [form] });
    this.restart(session);
  }

  private answer(session: Session, peer: Peer, message: Message): void {
    const [id, pixel] = [message["id"], [message["x"], message["y"]]];
    const common = { id, revision: this.revision, seq: session.seq };
    const { scene, picture: _, ...page } = this.rays;
    if (message.type === "ghost") return peer.say({ type: "ghost", ...common, scene });
    if (message.type === "pick") {
      const rgb = session.layer === "cost" ? [17, 23, 0] : [0.25, 0.5, 0.125];
      return peer.say({
        type: "pick", ...common, pixel, object: "red ball", index: 0, material: "red", form: "material/0", light: null, t: 4.25, depth: 4, point: [0, 0, 1],
        normal: [0, 0, 1], uv: [0.5, 0.5], primitive: 0, rgb, samples: 3,
      });
    }
    const depth = session.forms.find(({ id: name }) => name === "integrator")!.params.find(({ name }: Param) => name === "maxdepth")!.value as number | null;
    const sample = typeof message["sample"] === "number" ? message["sample"] : 1;
    const trees = (depth ?? 5) <= 2 ? page.other!.trees : page.trees;
    const chosen = [trees.find((tree) => tree.sample === sample) ?? trees[0]!, ...(message["samples"] ? trees.filter((tree) => tree.sample !== sample) : [])];
    const values = message["samples"] ? page.values : [];
    peer.say({ type: "trace", ...common, ms: 1.5, page: { ...page, trees: chosen, values, dims: values.length ? page.dims : [], other: message["diff"] ? page.other : null } });
  }
}
