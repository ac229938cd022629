import type { EventKind } from "../../../api/protocol";
import type { Entry } from "./events";

/** The half of the width of the slider's thumb: the ends of its range are this far inside of it. */
export const inset_px = 8;

const near_px = 6;

/** Where marks are drawn. */
export interface Scale {
  width_px: number;
  /** The last tick. */
  edge: number;
}

export function x_px(tick: number, { width_px, edge }: Scale): number {
  return inset_px + ((width_px - 2 * inset_px) * tick) / Math.max(1, edge);
}

/** The entry whose mark is nearest to a position; undefined if none is near. */
export function entryAt(entries: Entry[], x: number, scale: Scale): Entry | undefined {
  let best: Entry | undefined;
  let bestDistance = near_px;
  for (const entry of entries) {
    const distance = Math.abs(x_px(entry.at, scale) - x);
    if (distance <= bestDistance) [best, bestDistance] = [entry, distance];
  }
  return best;
}

/** Draws a mark of each event, kind after kind, and a triangle at each branch. */
export function drawMarks(
  canvas: HTMLCanvasElement,
  { entries, kinds, branches }: { entries: Entry[]; kinds: EventKind[]; branches: number[] },
  edge: number,
): void {
  const context = canvas.getContext("2d");
  const { clientWidth: width_px, clientHeight: height_px } = canvas;
  const ratio = devicePixelRatio;
  [canvas.width, canvas.height] = [Math.round(width_px * ratio), Math.round(height_px * ratio)];
  if (!context) return;
  context.scale(ratio, ratio);
  const style = getComputedStyle(canvas);
  const colour = (name: string) => style.getPropertyValue(`--${name}`).trim();
  const scale = { width_px, edge };
  const places = new Map(kinds.map(({ id }) => [id, new Set<number>()]));
  for (const { kind, at } of entries) places.get(kind)?.add(Math.round(x_px(at, scale) * 2) / 2);
  for (const { id, colour: name } of kinds) {
    context.fillStyle = colour(name);
    for (const x of places.get(id) ?? []) context.fillRect(x - 1, 0, 2, height_px);
  }
  context.fillStyle = colour("text");
  for (const tick of branches) {
    const x = x_px(tick, scale);
    context.beginPath();
    context.moveTo(x - 4, height_px);
    context.lineTo(x + 4, height_px);
    context.lineTo(x, height_px - 6);
    context.fill();
  }
}
