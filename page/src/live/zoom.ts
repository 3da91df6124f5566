// Where the film lies on the screen: fitted, or enlarged around a place of it.

/** Null fits the whole film; else screen pixels per film pixel, and the place of the film in the middle. */
export type Zoom = { scale: number; x: number; y: number } | null;

export interface Placed { scale: number; left: number; top: number }

export type Size = [number, number];

const [LEAST, MOST] = [1 / 16, 64];

export function fitting([w, h]: Size, [fw, fh]: Size): number {
  return Math.min(w / Math.max(fw, 1), h / Math.max(fh, 1)) || 1;
}

export function placed(zoom: Zoom, size: Size, film: Size): Placed {
  const scale = zoom?.scale ?? fitting(size, film);
  const [x, y] = zoom ? [zoom.x, zoom.y] : [film[0] / 2, film[1] / 2];
  return { scale, left: size[0] / 2 - x * scale, top: size[1] / 2 - y * scale };
}

/** The place of the film under a place of the screen. */
export function onFilm(at: Size, p: Placed): Size {
  return [(at[0] - p.left) / p.scale, (at[1] - p.top) / p.scale];
}

/** The pixel there; null beside the film. */
export function pixelAt(at: Size, p: Placed, film: Size): Size | null {
  const [x, y] = onFilm(at, p).map(Math.floor) as Size;
  return x >= 0 && y >= 0 && x < film[0] && y < film[1] ? [x, y] : null;
}

/** Enlarges around a place of the screen. Back at the fitted size or below it fits again. */
export function zoomed(zoom: Zoom, factor: number, at: Size, size: Size, film: Size): Zoom {
  const before = placed(zoom, size, film);
  const scale = Math.min(Math.max(before.scale * factor, LEAST), MOST);
  if (factor < 1 && scale <= fitting(size, film)) return null;
  const [x, y] = onFilm(at, before);
  return held({ scale, x: x - (at[0] - size[0] / 2) / scale, y: y - (at[1] - size[1] / 2) / scale }, film);
}

/** Moves what is seen by screen pixels. */
export function shifted(zoom: Zoom, dx: number, dy: number, film: Size): Zoom {
  return zoom && held({ ...zoom, x: zoom.x - dx / zoom.scale, y: zoom.y - dy / zoom.scale }, film);
}

/** Some of the film stays in the middle. */
function held(zoom: NonNullable<Zoom>, film: Size): Zoom {
  return { ...zoom, x: Math.min(Math.max(zoom.x, 0), film[0]), y: Math.min(Math.max(zoom.y, 0), film[1]) };
}
