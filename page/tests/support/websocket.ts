// As much of a WebSocket server (RFC 6455) as stands in for durer's in tests: whole text messages in, text and bytes out.
import { createHash } from "node:crypto";
import type { IncomingMessage } from "node:http";
import type { Duplex } from "node:stream";

const SALT = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";

export class Peer {
  onMessage: (text: string) => void = () => undefined;
  onEnd: () => void = () => undefined;
  private rest = Buffer.alloc(0);

  constructor(request: IncomingMessage, private readonly stream: Duplex) {
    const key = createHash("sha1").update(`${request.headers["sec-websocket-key"]}${SALT}`).digest("base64");
    stream.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${key}\r\n\r\n`);
    stream.on("data", (data: Buffer) => this.read(data));
    stream.on("close", () => this.onEnd());
    stream.on("error", () => undefined);
  }

  private read(data: Buffer): void {
    this.rest = Buffer.concat([this.rest, data]);
    for (;;) {
      if (this.rest.length < 2) return;
      const [kind, size] = [this.rest[0]! & 15, this.rest[1]! & 127];
      const extra = size === 126 ? 2 : size === 127 ? 8 : 0;
      if (this.rest.length < 6 + extra) return;
      const length = extra === 2 ? this.rest.readUInt16BE(2) : extra === 8 ? Number(this.rest.readBigUInt64BE(2)) : size;
      const end = 6 + extra + length;
      if (this.rest.length < end) return;
      const mask = this.rest.subarray(2 + extra, 6 + extra);
      const text = Buffer.from(this.rest.subarray(6 + extra, end).map((byte, i) => byte ^ mask[i % 4]!));
      this.rest = this.rest.subarray(end);
      if (kind === 1) this.onMessage(text.toString());
      else if (kind === 8) this.stream.end();
    }
  }

  private write(kind: number, body: Buffer): void {
    const head = body.length < 126 ? Buffer.from([0x80 | kind, body.length])
      : body.length < 65536 ? Buffer.from([0x80 | kind, 126, body.length >> 8, body.length & 255]) : Buffer.alloc(10);
    if (head.length === 10) {
      [head[0], head[1]] = [0x80 | kind, 127];
      head.writeBigUInt64BE(BigInt(body.length), 2);
    }
    if (!this.stream.destroyed) this.stream.write(Buffer.concat([head, body]));
  }

  say(message: object): void {
    this.write(1, Buffer.from(JSON.stringify(message)));
  }

  bytes(body: Buffer): void {
    this.write(2, body);
  }

  close(code: number): void {
    this.write(8, Buffer.from([code >> 8, code & 255]));
    this.stream.end();
  }
}
