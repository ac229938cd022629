/** A canvas with as many pixels as the screen has where it lies. */
export class Surface {
  readonly context: CanvasRenderingContext2D;

  /** `inMemory`: its pixels need not be where the picture is put together. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    inMemory = false,
  ) {
    const context = canvas.getContext("2d", { willReadFrequently: inMemory });
    if (!context) throw new Error("This browser draws no pictures (no Canvas2D).");
    this.context = context;
  }

  /** Wipes it, and draws in CSS pixels. */
  draw(ratio: number, paint: (context: CanvasRenderingContext2D) => void): void {
    const { context, canvas } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    paint(context);
  }

  /** A hidden canvas costs nothing when the page is put together. */
  show(shown: boolean): void {
    if (this.canvas.hidden === shown) this.canvas.hidden = !shown;
  }
}

/** More pixels than this a CSS pixel cannot be told apart, and cost time. */
const mostRatio = 2;

export function pixelRatio(): number {
  return Math.min(mostRatio, globalThis.devicePixelRatio || 1);
}

export function sizeTo(canvas: HTMLCanvasElement, width: number, height: number): void {
  const ratio = pixelRatio();
  canvas.width = Math.max(1, Math.round(width * ratio));
  canvas.height = Math.max(1, Math.round(height * ratio));
}
