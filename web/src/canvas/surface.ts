/** A canvas at the resolution of the screen. */
export class Surface {
  readonly context: CanvasRenderingContext2D;

  /** `inMemory`: keep the pixels in main memory, not on the graphics card. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    inMemory = false,
  ) {
    const context = canvas.getContext("2d", { willReadFrequently: inMemory });
    if (!context) throw new Error("This browser does not support Canvas 2D.");
    this.context = context;
  }

  /** Clears the canvas and draws in CSS pixels. */
  draw(ratio: number, paint: (context: CanvasRenderingContext2D) => void): void {
    const { context, canvas } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    paint(context);
  }

  /** A hidden canvas costs nothing in compositing. */
  show(shown: boolean): void {
    if (this.canvas.hidden === shown) this.canvas.hidden = !shown;
  }
}

/** Higher ratios are not visible and cost time. */
const maxRatio = 2;

export function pixelRatio(): number {
  return Math.min(maxRatio, globalThis.devicePixelRatio || 1);
}

export function sizeTo(canvas: HTMLCanvasElement, width: number, height: number): void {
  const ratio = pixelRatio();
  canvas.width = Math.max(1, Math.round(width * ratio));
  canvas.height = Math.max(1, Math.round(height * ratio));
}
