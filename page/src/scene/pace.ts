// Fewer pixels while things move where drawing is slow, all of them at rest.

/** Milliseconds from one frame to the next above which drawing is slow. */
const SLOW = 60;

/** Milliseconds without a frame after which things are at rest. */
const REST = 260;

export class Pace {
  /** Share of the pixels' density that is drawn. */
  density = 1;
  private slow = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly changed: () => void) {}

  /** Called when a frame was drawn: the time until the next one could be says how long it took. */
  drawn(now: number): void {
    clearTimeout(this.timer);
    requestAnimationFrame((next) => {
      this.slow = next - now > SLOW ? this.slow + 1 : 0;
      if (this.slow >= 2 && this.density === 1) this.set(0.5);
    });
    if (this.density < 1) this.timer = setTimeout(() => this.set(1), REST);
  }

  private set(density: number): void {
    this.density = density;
    this.slow = 0;
    this.changed();
  }
}
