// The live picture with its tools above: moved by hand, magnified, and split by a line that is dragged.
import { effect } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { attach } from "../../live/hands";
import type { Hand, Live } from "../../live/live";
import { paint } from "../../live/paint";
import { fitting } from "../../live/zoom";
import { Choice } from "../parts";
import { nameOf } from "./Split";

const HANDS: [Hand, string][] = [["orbit", "Orbit"], ["fly", "Fly"], ["zoom", "Magnify"]];

export function PictureView({ live }: { live: Live }): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => follow(canvas.current!, live), []);
  const { main, zoom, size, film, lying, against } = live;
  const header = main.picture.value?.header;
  const scale = zoom.value?.scale ?? fitting(size.value, film.value);
  const exact = main.camera.value?.exact ?? true;
  const label = `Picture of ${main.scene.value?.name ?? "the scene"}, ${header ? `${header.samples} of ${header.of} samples` : "not there yet"}. Arrow keys move the mark, Enter traces it; W S Q Z J L I K move the camera.`;
  return (
    <div class={`view picture hand-${live.hand.value}`}>
      <canvas ref={canvas} tabIndex={0} role="application" aria-label={label} />
      {against.value && <Divider live={live} />}
      {against.value && (
        <div class="sides" aria-hidden="true" style={{ left: `${lying.value.left + film.value[0] * lying.value.scale * live.divide.value}px` }}>
          <span>{main.forms.value.get("integrator")?.kind ?? "here"}</span><span>{nameOf(live)}</span>
        </div>
      )}
      <div class="tools" role="toolbar" aria-label="Picture">
        <Choice<Hand> label="What dragging does" value={live.hand.value} options={HANDS} onChange={(hand) => (live.hand.value = hand)} />
        <button type="button" title="The scene’s own camera (R)" disabled={exact} onClick={() => live.home(null)}>Reset view</button>
        <button type="button" class={zoom.value ? "" : "one"} title="All of the film, or one pixel of it as one of the screen (0)" aria-pressed={zoom.value !== null}
          onClick={() => (zoom.value ? live.enlarge(null) : live.actual())}>{zoom.value ? "Fit" : "1:1"}<span class="hidden">, now {Math.round(scale * 100)} percent</span></button>
        <label class="layer"><span class="hidden">Layer</span>
          <select value={main.layer.value} onChange={(event) => main.show(event.currentTarget.value)}>
            {main.layers.value.map((layer) => <option key={layer} value={layer}>{layer}</option>)}
          </select></label>
        <button type="button" aria-pressed={against.value !== null} title="Compare with another integrator or a picture (V)"
          onClick={() => (against.value ? live.unsplit() : live.split())}>Split</button>
        <button type="button" aria-pressed={live.paused.value} title="Pause (Space)" onClick={() => live.pause(!live.paused.value)}>{live.paused.value ? "Go on" : "Pause"}</button>
      </div>
    </div>
  );
}

/** Keeps the canvas in step with what it shows, until what it returns is called. */
function follow(canvas: HTMLCanvasElement, live: Live): () => void {
  const context = canvas.getContext("2d", { alpha: true })!;
  let waiting = 0;
  let frames = 0;
  const draw = (): void => {
    waiting = 0;
    const density = Math.min(devicePixelRatio, 3);
    const [w, h] = live.size.peek();
    if (canvas.width !== Math.round(w * density) || canvas.height !== Math.round(h * density)) {
      [canvas.width, canvas.height] = [Math.round(w * density), Math.round(h * density)];
    }
    const other = live.against.peek();
    const right = other?.is === "session" ? other.session.picture.peek() : null;
    const picture = live.main.picture.peek();
    paint(context, density, {
      size: [w, h], placed: live.lying.peek(), film: live.film.peek(), picture,
      other: other?.is === "image" ? { image: other.image, fine: true } : right && { image: right.image, fine: right.header.width >= right.header.film[0] },
      divide: live.divide.peek(), pixel: live.rays.pixel.peek(), cursor: live.cursor.peek(), dark: live.looks.dark.peek(),
    });
    canvas.dataset["frames"] = String(++frames);
    if (picture) Object.assign(canvas.dataset, { samples: picture.header.samples, seq: picture.header.seq, done: picture.header.done, layer: picture.header.layer, revision: picture.header.revision });
  };
  const stop = effect(() => {
    const other = live.against.value;
    if (other?.is === "session") other.session.picture.value;
    void [live.main.picture.value, live.lying.value, live.size.value, live.divide.value, live.rays.pixel.value, live.cursor.value, live.looks.dark.value];
    waiting ||= requestAnimationFrame(draw);
  });
  const observer = new ResizeObserver(() => (live.size.value = [canvas.clientWidth || 1, canvas.clientHeight || 1]));
  observer.observe(canvas);
  const off = attach(canvas, live.hands);
  return () => {
    stop();
    observer.disconnect();
    cancelAnimationFrame(waiting);
    off();
  };
}

/** The line between the two pictures. */
function Divider({ live }: { live: Live }): JSX.Element {
  const { lying, film, divide } = live;
  const x = lying.value.left + film.value[0] * lying.value.scale * divide.value;
  const set = (share: number): void => void (divide.value = Math.min(Math.max(share, 0), 1));
  const lead = (event: PointerEvent): void => {
    if (event.type === "pointermove" && event.buttons === 0) return;
    const box = (event.currentTarget as Element).parentElement!.getBoundingClientRect();
    set((event.clientX - box.left - lying.value.left) / (film.value[0] * lying.value.scale));
  };
  const step = (event: KeyboardEvent): void => {
    const by = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    set(divide.value + by);
  };
  return (
    <div class="divider" role="slider" tabIndex={0} aria-label="Where the picture is split" aria-orientation="horizontal" aria-valuemin={0} aria-valuemax={100}
      aria-valuenow={Math.round(divide.value * 100)} style={{ left: `${x}px` }} onKeyDown={step}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)} onPointerMove={lead}><i /></div>
  );
}
