// The connection to `durer view`: comes back by itself when it breaks, resumes its session, and brings answers to who asked.
import { signal } from "@preact/signals";

import { readFrame, readMessage, type Complaint, type Frame, type FromServer, type Requests, type ToServer } from "./protocol";

/** What the program tells everybody who listens. */
export interface Listener {
  message(message: FromServer): void;
  frame(frame: Frame): void;
}

/** As much of a browser's socket as is used. */
export interface Socket {
  binaryType: string;
  readyState: number;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  send(text: string): void;
  close(code?: number): void;
}

export type LinkState = { is: "connecting" } | { is: "open" } | { is: "lost"; tries: number; at: number } | { is: "stopped"; why: string };

/** Another socket took over the session. */
const TAKEN = 1008;
const GONE = 1001;

/** Milliseconds before the try after `tries` failed ones: doubled each time, up to ten seconds, a little by chance. */
export function backOff(tries: number, chance = Math.random()): number {
  return Math.min(250 * 2 ** Math.min(tries, 10), 10_000) * (0.8 + 0.4 * chance);
}

/** The question failed; the program says why. */
export class Refused extends Error {
  constructor(readonly complaint: Complaint) {
    super(complaint.hint ? `${complaint.message} (${complaint.hint})` : complaint.message);
  }
}

interface Waiting { resolve: (reply: never) => void; reject: (error: Error) => void }

export class Link {
  readonly state = signal<LinkState>({ is: "connecting" });
  /** Session to resume. */
  session: string | null;
  private socket: Socket | null = null;
  private tries = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private lastId = 0;
  private readonly waiting = new Map<number, Waiting>();
  private ended = false;

  /** `make` opens a socket for `session=…` or `from=…`; `from`: the session that a new one is a copy of. */
  constructor(private readonly make: (query: string) => Socket, private readonly listener: Listener, start: { session?: string | null; from?: string | null } = {}) {
    this.session = start.session ?? null;
    this.from = start.from ?? null;
    this.connect();
  }
  private from: string | null;

  private connect(): void {
    clearTimeout(this.timer);
    if (this.ended) return;
    const query = this.session ? `&session=${encodeURIComponent(this.session)}` : this.from ? `&from=${encodeURIComponent(this.from)}` : "";
    const socket = this.make(query);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    if (this.state.peek().is === "stopped") this.state.value = { is: "connecting" };
    socket.onmessage = ({ data }) => this.hear(data);
    socket.onclose = ({ code }) => this.lost(socket, code);
  }

  private hear(data: unknown): void {
    if (data instanceof ArrayBuffer) {
      const frame = readFrame(data);
      if (frame) this.listener.frame(frame);
      return;
    }
    const message = readMessage(String(data));
    if (!message) return;
    if (message.type === "hello") {
      this.tries = 0;
      this.session = message.session;
      this.state.value = { is: "open" };
    } else if ("id" in message && typeof message.id === "number" && this.answer(message.id, message)) return;
    this.listener.message(message);
  }

  private answer(id: number, message: FromServer): boolean {
    const who = this.waiting.get(id);
    if (!who) return false;
    this.waiting.delete(id);
    if (message.type === "error") who.reject(new Refused(message));
    else who.resolve(message as never);
    return true;
  }

  private lost(socket: Socket, code: number): void {
    if (socket !== this.socket || this.ended) return;
    this.socket = null;
    this.waiting.forEach(({ reject }) => reject(new Error("the connection broke")));
    this.waiting.clear();
    if (code === TAKEN && this.session) {
      // Opened twice, as by a copied tab: this one goes on with a session of its own that begins where that one is.
      this.from = this.session;
      this.session = null;
    }
    const wait = code === TAKEN ? 0 : backOff(this.tries);
    this.tries += 1;
    this.state.value = { is: "lost", tries: code === GONE ? Math.max(this.tries, 2) : this.tries, at: Date.now() + wait };
    this.timer = setTimeout(() => this.connect(), wait);
  }

  /** Tries at once, if it waits. */
  retry(): void {
    if (this.state.peek().is === "lost" && this.socket === null) this.connect();
  }

  get open(): boolean {
    return this.socket !== null && this.socket.readyState === 1 && this.state.peek().is === "open";
  }

  /** Sends if there is a connection; after a break the session is told anew what counts. */
  send(message: ToServer): void {
    if (this.open) this.socket!.send(JSON.stringify(message));
  }

  ask<K extends keyof Requests>(type: K, order: Requests[K]["order"]): Promise<Requests[K]["reply"]> {
    if (!this.open) return Promise.reject(new Error("there is no connection"));
    const id = ++this.lastId;
    this.socket!.send(JSON.stringify({ ...order, type, id }));
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve: resolve as (reply: never) => void, reject }));
  }

  /** Ends it; there is no way back. */
  close(): void {
    this.ended = true;
    clearTimeout(this.timer);
    this.socket?.close(1000);
    this.socket = null;
  }

  /** The page is of another version: nothing is tried any more. */
  stop(why: string): void {
    this.close();
    this.state.value = { is: "stopped", why };
  }
}
