// `durer view` itself, started for a test and stopped after it; and what its door says to strangers.
import { spawn, type ChildProcess } from "node:child_process";
import { request, type IncomingHttpHeaders } from "node:http";

export interface Answer { status: number; headers: IncomingHttpHeaders; body: string }

export class Program {
  address = "";
  private out = "";
  private errors = "";
  private constructor(private readonly child: ChildProcess) {}

  /** Starts it and waits for its address. */
  static async start(durer: string, words: string[]): Promise<Program> {
    // While the page is worked on, a debug build serves the file anew at each request.
    const page = process.env["DURER_VIEW_PAGE"];
    const child = spawn(durer, ["view", ...words, "--port", "0", ...(page ? ["--page", page] : [])], { stdio: ["ignore", "pipe", "pipe"] });
    const program = new Program(child);
    child.stdout!.on("data", (data: Buffer) => (program.out += data.toString()));
    child.stderr!.on("data", (data: Buffer) => (program.errors += data.toString()));
    const until = Date.now() + 60_000;
    for (;;) {
      program.address = /http:\/\/\S+/.exec(program.out)?.[0] ?? "";
      if (program.address !== "") return program;
      if (child.exitCode !== null || Date.now() > until) throw new Error(`durer view does not start: ${program.errors}`);
      await new Promise((done) => setTimeout(done, 20));
    }
  }

  get url(): URL {
    return new URL(this.address);
  }

  get token(): string {
    return this.url.searchParams.get("token")!;
  }

  /** Ctrl-C. What it exits with. */
  async stop(): Promise<number | null> {
    if (this.child.exitCode !== null) return this.child.exitCode;
    const ended = new Promise<number | null>((done) => this.child.once("exit", (code) => done(code)));
    this.child.kill("SIGINT");
    const late = setTimeout(() => this.child.kill("SIGKILL"), 20_000);
    const code = await ended;
    clearTimeout(late);
    return code;
  }

  /** Asks as any program may: the path goes out as it is written. */
  ask(path: string, how: { method?: string; headers?: Record<string, string> } = {}): Promise<Answer> {
    const { hostname, port } = this.url;
    return new Promise((resolve, reject) => {
      const asked = request({ hostname, port, path, method: how.method ?? "GET", headers: how.headers ?? {}, agent: false }, (answer) => {
        let body = "";
        answer.on("data", (data: Buffer) => (body += data.toString("latin1")));
        answer.on("end", () => resolve({ status: answer.statusCode!, headers: answer.headers, body }));
      });
      asked.on("upgrade", (answer, socket) => {
        socket.destroy();
        resolve({ status: answer.statusCode!, headers: answer.headers, body: "" });
      });
      asked.on("error", reject);
      asked.end();
    });
  }
}

/** What a browser sends to open a WebSocket. */
export const UPGRADE = { Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==" };
