import type { Point } from "../api/protocol";

/** Receives gestures, in pixels of the element. */
export interface GestureHandler {
  /** A drag starts; true if the handler uses it, false to pan the view. */
  press(at: Point): boolean;
  drag(at: Point): void;
  release(at: Point): void;
  /** A press and release without a drag. */
  tap(at: Point): void;
  pan(dx: number, dy: number): void;
  zoom(at: Point, factor: number): void;
}

const tapTolerance_px = 4;
const zoomPerPixel = 0.0015;
const pixelsPerLine = 32;

/** Turns pointer and wheel events of an element into gestures. */
export class Gestures {
  private readonly down = new Map<number, Point>();
  private began: Point = [0, 0];
  private moved = false;
  private taken = false;

  constructor(
    private readonly element: HTMLElement,
    private readonly handler: GestureHandler,
  ) {
    element.addEventListener("pointerdown", (event) => this.press(event));
    element.addEventListener("pointermove", (event) => this.move(event));
    element.addEventListener("pointerup", (event) => this.lift(event));
    element.addEventListener("pointercancel", (event) => this.lift(event));
    element.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.element.setPointerCapture(event.pointerId);
    const at = this.at(event);
    this.down.set(event.pointerId, at);
    if (this.down.size > 1) return;
    [this.began, this.moved] = [at, false];
    this.taken = this.handler.press(at);
  }

  private move(event: PointerEvent): void {
    const before = this.down.get(event.pointerId);
    if (!before) return;
    const at = this.at(event);
    if (distance(at, this.began) > tapTolerance_px) this.moved = true;
    if (this.down.size === 2) this.pinch(event.pointerId, at);
    else if (this.taken) this.handler.drag(at);
    else if (this.moved) this.handler.pan(at[0] - before[0], at[1] - before[1]);
    this.down.set(event.pointerId, at);
  }

  private lift(event: PointerEvent): void {
    if (!this.down.delete(event.pointerId) || this.down.size > 0) return;
    const at = this.at(event);
    if (this.taken) this.handler.release(at);
    else if (!this.moved && event.type === "pointerup") this.handler.tap(at);
  }

  private pinch(moving: number, at: Point): void {
    this.moved = true;
    const before = this.down.get(moving);
    const other = [...this.down].find(([id]) => id !== moving)?.[1];
    if (!before || !other) return;
    const middle: Point = [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2];
    this.handler.pan((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
    this.handler.zoom(middle, distance(at, other) / Math.max(1, distance(before, other)));
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? pixelsPerLine : 1);
    this.handler.zoom(this.at(event), Math.exp(-pixels * zoomPerPixel));
  }

  private at(event: MouseEvent): Point {
    const { left, top } = this.element.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }
}

function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}
