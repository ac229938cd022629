import type { Point } from "../api/protocol";

/** What pointers ask for, in pixels of the element. */
export interface Hands {
  /** A drag begins; true if it is taken for something else than moving the picture. */
  press(at: Point): boolean;
  drag(at: Point): void;
  release(at: Point): void;
  /** A press that went nowhere. */
  tap(at: Point): void;
  pan(dx: number, dy: number): void;
  zoom(at: Point, factor: number): void;
}

const still_px = 4;
const zoomPerPixel = 0.0015;
const pixelsPerLine = 32;

/** Turns what pointers and wheel do on an element into what is meant. */
export class Gestures {
  private readonly down = new Map<number, Point>();
  private began: Point = [0, 0];
  private moved = false;
  private taken = false;

  constructor(
    private readonly element: HTMLElement,
    private readonly hands: Hands,
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
    this.taken = this.hands.press(at);
  }

  private move(event: PointerEvent): void {
    const before = this.down.get(event.pointerId);
    if (!before) return;
    const at = this.at(event);
    if (distance(at, this.began) > still_px) this.moved = true;
    if (this.down.size === 2) this.pinch(event.pointerId, at);
    else if (this.taken) this.hands.drag(at);
    else if (this.moved) this.hands.pan(at[0] - before[0], at[1] - before[1]);
    this.down.set(event.pointerId, at);
  }

  private lift(event: PointerEvent): void {
    if (!this.down.delete(event.pointerId) || this.down.size > 0) return;
    const at = this.at(event);
    if (this.taken) this.hands.release(at);
    else if (!this.moved && event.type === "pointerup") this.hands.tap(at);
  }

  private pinch(moving: number, at: Point): void {
    this.moved = true;
    const before = this.down.get(moving);
    const other = [...this.down].find(([id]) => id !== moving)?.[1];
    if (!before || !other) return;
    const middle: Point = [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2];
    this.hands.pan((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
    this.hands.zoom(middle, distance(at, other) / Math.max(1, distance(before, other)));
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? pixelsPerLine : 1);
    this.hands.zoom(this.at(event), Math.exp(-pixels * zoomPerPixel));
  }

  private at(event: MouseEvent): Point {
    const { left, top } = this.element.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }
}

function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}
