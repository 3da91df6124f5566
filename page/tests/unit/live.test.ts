// The live page without a browser: its camera, the film on the screen, fields, frames and the connection.
import { signal } from "@preact/signals";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { cross, distance, dot, length, plus, scaled, sub, unit } from "../../src/data/vector";
import type { Vec3 } from "../../src/data/types";
import { dolly, fly, look, orbit, pan, rightOf, trueUp, type Pose, type World } from "../../src/live/camera";
import { counts, hexOf, numberOf, rgbOf, sliderOf, stepOf, told } from "../../src/live/fields";
import { backOff, Link, Refused, type Socket } from "../../src/live/link";
import { createPointing } from "../../src/live/pointing";
import { readFrame, readMessage, type FromServer, type Param } from "../../src/live/protocol";
import type { Picture, Session } from "../../src/live/session";
import { fitting, onFilm, pixelAt, placed, shifted, zoomed, type Size } from "../../src/live/zoom";

const near = (a: Vec3, b: Vec3, within = 1e-9): void => expect(distance(a, b), `${a} is not ${b}`).toBeLessThan(within);
const pivotOf = (pose: Pose): Vec3 => plus(pose.eye, scaled(pose.forward, pose.distance));
const WORLDS: [string, World][] = [
  ["right-handed, y up", { up: [0, 1, 0], hand: 1, size: 3 }], ["left-handed, z up", { up: [0, 0, 1], hand: -1, size: 3 }], ["upside down", { up: [0, -1, 0], hand: 1, size: 3 }],
];

/** A camera that looks across the world's up, a little down. */
function start(world: World): Pose {
  const ahead = unit(cross(world.up, [0.3, 0.4, 0.5]));
  const forward = unit(plus(ahead, scaled(world.up, -0.2)));
  return { eye: [1, 2, 3], forward, up: world.up, distance: 4 };
}

describe.each(WORLDS)("the camera in a world that is %s", (_, world) => {
  const pose = start(world);
  const right = rightOf(pose, world);

  it("knows right and up: perpendicular, and of the world's hand", () => {
    const up = trueUp(pose, world);
    for (const v of [right, up]) expect(length(v)).toBeCloseTo(1, 12);
    expect(dot(right, pose.forward)).toBeCloseTo(0, 12);
    expect(dot(up, world.up)).toBeGreaterThan(0.9);
    // right x up looks backwards in right-handed worlds.
    near(cross(right, up), scaled(pose.forward, -world.hand));
  });

  it("turns around its pivot, which stays; the eye goes against the hand", () => {
    const next = orbit(pose, world, 0.3, 0.2);
    near(pivotOf(next), pivotOf(pose));
    expect(distance(next.eye, pivotOf(next))).toBeCloseTo(4, 12);
    expect(dot(sub(next.eye, pose.eye), right)).toBeLessThan(0);
    expect(dot(sub(next.eye, pose.eye), world.up)).toBeGreaterThan(0);
    near(orbit(orbit(pose, world, 0.3, 0.2), world, -0.3, -0.2).eye, pose.eye);
  });

  it("does not turn over the top, and comes back from there", () => {
    const top = orbit(pose, world, 0, 9);
    expect(dot(top.forward, world.up)).toBeGreaterThan(-1);
    expect(dot(top.forward, world.up)).toBeLessThan(-0.999);
    expect(dot(rightOf(top, world), right)).toBeCloseTo(1, 6);
    expect(dot(orbit(top, world, 0, -1).forward, world.up)).toBeGreaterThan(dot(top.forward, world.up));
  });

  it("leaves straight down to the side that was ahead", () => {
    const down: Pose = { eye: [0, 0, 0], forward: scaled(world.up, -1), up: unit(cross(world.up, [0.3, 0.4, 0.5])), distance: 1 };
    const next = orbit(down, world, 0, -0.5);
    expect(dot(next.forward, down.up)).toBeGreaterThan(0.4);
  });

  it("looks around without leaving its place", () => {
    const next = look(pose, world, 0.2, 0.1);
    near(next.eye, pose.eye);
    expect(dot(next.forward, right)).toBeCloseTo(Math.sin(0.2) * Math.hypot(dot(next.forward, right), dot(next.forward, unit(sub(pose.forward, scaled(world.up, dot(pose.forward, world.up)))))), 6);
    expect(dot(next.forward, world.up)).toBeGreaterThan(dot(pose.forward, world.up));
  });

  it("shifts what lies at the pivot by just as much as the hand", () => {
    // A drag over the whole height moves the pivot by the whole height that is seen there.
    const next = pan(pose, world, 0, 1, 60);
    expect(dot(sub(next.eye, pose.eye), trueUp(pose, world))).toBeCloseTo(2 * Math.tan(Math.PI / 6) * 4, 9);
    expect(dot(sub(pan(pose, world, 0.1, 0, 60).eye, pose.eye), right)).toBeLessThan(0);
    near(next.forward, pose.forward);
  });

  it("comes nearer, but never through", () => {
    near(pivotOf(dolly(pose, world, 0.5)), pivotOf(pose));
    expect(dolly(pose, world, 0.5).distance).toBe(2);
    expect(dolly(pose, world, 0).distance).toBeGreaterThan(0);
    near(fly(pose, world, 1, 0, 0).forward, pose.forward);
    expect(dot(sub(fly(pose, world, 0.1, 0, 0).eye, pose.eye), pose.forward)).toBeCloseTo(0.3, 9);
  });
});

describe("the film on the screen", () => {
  const [size, film]: [Size, Size] = [[800, 600], [320, 180]];

  it("fits, in the middle", () => {
    const p = placed(null, size, film);
    expect(p).toEqual({ scale: 2.5, left: 0, top: 75 });
    expect(pixelAt([0, 75], p, film)).toEqual([0, 0]);
    expect(pixelAt([799.9, 524.9], p, film)).toEqual([319, 179]);
    expect(pixelAt([400, 74], p, film)).toBeNull();
  });

  it("is enlarged around what is under the mouse", () => {
    const at: Size = [600, 300];
    const before = onFilm(at, placed(null, size, film));
    const zoom = zoomed(null, 3, at, size, film);
    onFilm(at, placed(zoom, size, film)).forEach((x, i) => expect(x).toBeCloseTo(before[i]!, 9));
    expect(zoomed(zoom, 0.1, at, size, film)).toBeNull();
    expect(zoomed(zoom, 1e9, at, size, film)!.scale).toBe(64);
  });

  it("moves with the hand, and stays in sight", () => {
    const zoom = { scale: 10, x: 100, y: 50 };
    expect(shifted(zoom, 50, -20, film)).toEqual({ scale: 10, x: 95, y: 52 });
    expect(shifted(zoom, 1e6, 0, film)!.x).toBe(0);
    expect(shifted(null, 9, 9, film)).toBeNull();
    expect(fitting([10, 10], [0, 0])).toBe(10);
  });
});

describe("fields", () => {
  const param = (more: Partial<Param>): Param => ({ name: "x", type: "float", doc: "", unit: "", default: null, value: null, min: null, max: null, words: null, editable: true, ...more });

  it("show the default where nothing is given", () => {
    expect(counts(param({ default: 0.5 }))).toBe(0.5);
    expect(counts(param({ default: 0.5, value: 0 }))).toBe(0);
    expect(counts(param({ type: "bool", default: true, value: false }))).toBe(false);
  });

  it("take numbers, and only those that are allowed", () => {
    const p = { min: 0, max: 1 };
    expect(numberOf(" 0,5", p, false)).toBe(0.5);
    expect(numberOf("1e-3", p, false)).toBe(0.001);
    for (const text of ["", "x", "2", "-1", "NaN", "Infinity"]) expect(numberOf(text, p, false), text).toBeNull();
    expect(numberOf("1.5", { min: null, max: null }, true)).toBeNull();
    expect(numberOf("−3", { min: null, max: null }, true)).toBe(-3);
  });

  it("turn light into the browser's colours and back", () => {
    expect(hexOf([0, 0.5, 1])).toBe("#00bcff");
    expect(hexOf([Number.NaN, 0, 0])).toBe("#000000");
    // Brighter than white keeps its hue and its strength.
    expect(hexOf([4, 2, 0])).toBe("#ffbc00");
    rgbOf(hexOf([4, 2, 0]), [4, 2, 0]).forEach((x, i) => expect(x).toBeCloseTo([4, 2, 0][i]!, 1));
    for (let grey = 0; grey < 256; grey++) {
      const hex = `#${grey.toString(16).padStart(2, "0").repeat(3)}`;
      expect(hexOf(rgbOf(hex, [0, 0, 0]))).toBe(hex);
    }
  });

  it("have sliders only where the range has two near ends", () => {
    expect(sliderOf(param({ min: 0, max: 1 }))).toEqual({ min: 0, max: 1, step: 0.005 });
    expect(sliderOf(param({ type: "int", min: 0, max: 100 }))!.step).toBe(1);
    expect(sliderOf(param({ min: 0 }))).toBeNull();
    expect(sliderOf(param({ min: 0, max: 1e9 }))).toBeNull();
    expect(stepOf(param({}), 250)).toBe(10);
    expect(stepOf(param({ type: "int" }), 250)).toBe(1);
  });

  it("tell what cannot be changed here", () => {
    expect(told({ spectrum: "metal-Cu-k" })).toBe("spectrum metal-Cu-k");
    expect(told({ spectrum: [400, 1, 700, 1] })).toBe("spectrum of 2 values");
    expect(told({ texture: "wood" })).toBe("texture wood");
    expect(told(Array.from({ length: 40 }, (_, i) => i))).toContain("… (40)");
    expect(told(null)).toBe("–");
  });
});

describe("messages", () => {
  const bytes = (length: number, text: string, rest: number[]): ArrayBuffer => {
    const body = new TextEncoder().encode(text);
    const out = new Uint8Array(4 + body.length + rest.length);
    new DataView(out.buffer).setUint32(0, length, true);
    out.set(body, 4);
    out.set(rest, 4 + body.length);
    return out.buffer;
  };

  it("of bytes are a header and a picture", () => {
    const frame = readFrame(bytes(11, '{"frame":7}', [1, 2, 3]))!;
    expect(frame.header.frame).toBe(7);
    expect([...frame.png]).toEqual([1, 2, 3]);
  });

  it("that make no sense are none", () => {
    expect(readFrame(new ArrayBuffer(2))).toBeNull();
    expect(readFrame(bytes(99, "{}", []))).toBeNull();
    expect(readFrame(bytes(2, "{]", []))).toBeNull();
    for (const text of ["", "{", "null", "[]", "{}", '{"type":3}']) expect(readMessage(text), text).toBeNull();
  });
});

describe("what is under the mouse", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  /** A page whose questions are answered by hand, one after the other. */
  function page(): { picture: { value: Picture | null }; answers: ((rgb: Vec3 | null) => Promise<unknown>)[]; pointing: ReturnType<typeof createPointing> } {
    const answers: ((rgb: Vec3 | null) => Promise<unknown>)[] = [];
    const ask = (): Promise<unknown> => new Promise((done) => answers.push((rgb) => {
      done({ rgb });
      return vi.advanceTimersByTimeAsync(200);
    }));
    const picture = signal<Picture | null>(null);
    return { picture, answers, pointing: createPointing({ picture, link: { ask } } as unknown as Session) };
  }

  it("is asked again if the picture changed before the answer came, though the mouse is still", async () => {
    const { picture, answers, pointing } = page();
    pointing.point([3, 4]);
    picture.value = {} as Picture;
    expect(answers.length).toBe(1);
    await answers[0]!(null);
    expect(answers.length).toBe(2);
    await answers[1]!([1, 2, 3]);
    expect(pointing.hovered.value).toEqual({ pixel: [3, 4], found: { rgb: [1, 2, 3] } });
    expect(answers.length, "nothing changed since").toBe(2);
  });

  it("is asked of the last pixel only when the mouse moves on", async () => {
    const { answers, pointing } = page();
    pointing.point([1, 1]);
    pointing.point([2, 2]);
    pointing.point([3, 3]);
    await answers[0]!([0, 0, 0]);
    expect(pointing.hovered.value).toEqual({ pixel: [3, 3], found: null });
    await answers[1]!([1, 1, 1]);
    expect(pointing.hovered.value?.found).toEqual({ rgb: [1, 1, 1] });
    expect(answers.length).toBe(2);
  });
});

describe("the connection", () => {
  class Fake implements Socket {
    static all: Fake[] = [];
    binaryType = "";
    readyState = 1;
    onmessage: Socket["onmessage"] = null;
    onclose: Socket["onclose"] = null;
    sent: Record<string, unknown>[] = [];
    closed: number | null = null;
    constructor(readonly query: string) {
      Fake.all.push(this);
    }
    send(text: string): void {
      this.sent.push(JSON.parse(text) as Record<string, unknown>);
    }
    close(code = 1000): void {
      this.closed = code;
    }
    hears(message: object): void {
      this.onmessage?.({ data: JSON.stringify(message) });
    }
    hello(session: string): void {
      this.hears({ type: "hello", session });
    }
    breaks(code: number): void {
      this.readyState = 3;
      this.onclose?.({ code, reason: "" });
    }
  }
  let heard: FromServer[] = [];
  let frames = 0;
  const link = (start = {}): Link => new Link((query) => new Fake(query), { message: (message) => heard.push(message), frame: () => (frames += 1) }, start);
  const last = (): Fake => Fake.all[Fake.all.length - 1]!;

  beforeEach(() => {
    vi.useFakeTimers();
    [Fake.all, heard, frames] = [[], [], 0];
  });
  afterEach(() => void vi.useRealTimers());

  it("waits longer with each failure, ten seconds at most, and never not at all", () => {
    const waits = [0, 1, 2, 3, 9, 99].map((tries) => backOff(tries, 0.5));
    expect(waits).toEqual([250, 500, 1000, 2000, 10_000, 10_000]);
    expect(backOff(0, 0)).toBe(200);
  });

  it("resumes its session after a break", () => {
    const it = link();
    expect(last().query).toBe("");
    last().hello("abc");
    expect(it.state.value.is).toBe("open");
    last().breaks(1006);
    expect(it.state.value).toMatchObject({ is: "lost", tries: 1 });
    vi.advanceTimersByTime(400);
    expect(last().query).toBe("&session=abc");
    last().breaks(1006);
    expect(it.state.value).toMatchObject({ is: "lost", tries: 2 });
    expect(Fake.all.length).toBe(2);
    it.retry();
    expect(Fake.all.length).toBe(3);
    last().hello("abc");
    // After a success it begins anew.
    last().breaks(1006);
    expect(it.state.value).toMatchObject({ tries: 1 });
  });

  it("goes on with a session of its own where another page took this one", () => {
    const it = link({ session: "abc" });
    last().hello("abc");
    last().breaks(1008);
    vi.advanceTimersByTime(1);
    expect(last().query).toBe("&from=abc");
    last().hello("def");
    expect(it.session).toBe("def");
  });

  it("brings answers and refusals to who asked, and to nobody else", async () => {
    const it = link();
    last().hello("abc");
    const [a, b] = [it.ask("pick", { x: 1, y: 2 }), it.ask("pick", { x: 3, y: 4 })];
    const [first, second] = last().sent;
    expect(second).toMatchObject({ type: "pick", x: 3, y: 4 });
    last().hears({ type: "pick", id: second!["id"], object: "b" });
    last().hears({ type: "error", id: first!["id"], message: "no", hint: "why" });
    expect(await b).toMatchObject({ object: "b" });
    await expect(a).rejects.toThrow(new Refused({ about: "", message: "no", hint: "why" }).message);
    expect(heard.map(({ type }) => type)).toEqual(["hello"]);
    last().hears({ type: "error", id: null, about: "protocol", message: "?" });
    expect(heard.map(({ type }) => type)).toEqual(["hello", "error"]);
  });

  it("leaves no question open when it breaks", async () => {
    const it = link();
    await expect(it.ask("ghost", {})).rejects.toThrow("no connection");
    last().hello("abc");
    const asked = it.ask("ghost", {});
    last().breaks(1001);
    await expect(asked).rejects.toThrow("broke");
  });

  it("does not come back once it is closed", () => {
    const it = link();
    last().hello("abc");
    it.close();
    last().breaks(1000);
    vi.advanceTimersByTime(60_000);
    expect(Fake.all.length).toBe(1);
    expect(last().closed).toBe(1000);
  });
});
