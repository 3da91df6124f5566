// Draws the live picture: the newest frame where the film lies, what it is compared with beside it, and the chosen pixel.
import type { Picture } from "./session";
import type { Placed, Size } from "./zoom";

export interface Scene2d {
  size: Size;
  placed: Placed;
  film: Size;
  picture: Picture | null;
  /** What is right of the divider, and where that stands: a share of the film's width. */
  other: { image: ImageBitmap; fine: boolean } | null;
  divide: number;
  pixel: Size | null;
  cursor: Size | null;
  dark: boolean;
}

/** From this size on pixels have lines between them. */
const GRID = 12;

export function paint(c: CanvasRenderingContext2D, density: number, scene: Scene2d): void {
  const { size: [w, h], placed: { scale, left, top }, film: [fw, fh], picture, other, divide } = scene;
  c.setTransform(density, 0, 0, density, 0, 0);
  c.clearRect(0, 0, w, h);
  const draw = (image: ImageBitmap, fine: boolean): void => {
    // Coarse pictures are smoothed; of the full one the pixels are seen when it is enlarged.
    c.imageSmoothingEnabled = !fine || scale < 1.5;
    c.imageSmoothingQuality = scale < 1 ? "medium" : "low";
    c.drawImage(image, left, top, fw * scale, fh * scale);
  };
  if (picture) draw(picture.image, picture.header.width >= fw);
  if (other) {
    c.save();
    c.beginPath();
    c.rect(left + fw * scale * divide, 0, w, h);
    c.clip();
    c.clearRect(left, top, fw * scale, fh * scale);
    draw(other.image, other.fine);
    c.restore();
  }
  if (scale >= GRID) grid(c, scene);
  if (scene.cursor) reticle(c, scene, scene.cursor, false);
  if (scene.pixel) reticle(c, scene, scene.pixel, true);
}

function grid(c: CanvasRenderingContext2D, { size: [w, h], placed: { scale, left, top }, film: [fw, fh] }: Scene2d): void {
  c.strokeStyle = "rgb(128 128 128 / .35)";
  c.lineWidth = 1;
  c.beginPath();
  const [x0, x1] = [Math.max(0, Math.ceil(-left / scale)), Math.min(fw, Math.floor((w - left) / scale))];
  const [y0, y1] = [Math.max(0, Math.ceil(-top / scale)), Math.min(fh, Math.floor((h - top) / scale))];
  for (let x = x0; x <= x1; x++) {
    c.moveTo(Math.round(left + x * scale) + 0.5, Math.max(top, 0));
    c.lineTo(Math.round(left + x * scale) + 0.5, Math.min(top + fh * scale, h));
  }
  for (let y = y0; y <= y1; y++) {
    c.moveTo(Math.max(left, 0), Math.round(top + y * scale) + 0.5);
    c.lineTo(Math.min(left + fw * scale, w), Math.round(top + y * scale) + 0.5);
  }
  c.stroke();
}

/** A frame around a pixel with four lines that lead to it, seen on any ground. */
function reticle(c: CanvasRenderingContext2D, { placed: { scale, left, top } }: Scene2d, [px, py]: Size, chosen: boolean): void {
  const r = Math.max(scale / 2, 4);
  const [x, y] = [left + (px + 0.5) * scale, top + (py + 0.5) * scale];
  const path = (): void => {
    c.beginPath();
    c.rect(x - r, y - r, 2 * r, 2 * r);
    const arm = chosen ? 11 : 5;
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as Size[]) {
      c.moveTo(x + dx * (r + 2), y + dy * (r + 2));
      c.lineTo(x + dx * (r + 2 + arm), y + dy * (r + 2 + arm));
    }
    c.stroke();
  };
  c.setLineDash(chosen ? [] : [3, 2]);
  c.strokeStyle = "rgb(0 0 0 / .75)";
  c.lineWidth = 3.6;
  path();
  c.strokeStyle = chosen ? "#ffd659" : "#fff";
  c.lineWidth = 1.6;
  path();
  c.setLineDash([]);
}
