import { ItemState } from "../../api/frames";
import { toScreen } from "../camera";
import type { ColourName } from "../colours";
import type { Layer, Pen } from "./layer";

const half_px = 6;

/**
 * Items: a hollow diamond until found, then a disc with a tick; a crossed diamond if missed; clutter is a plus, and an
 * item that was destroyed a cross.
 */
export const items: Layer = {
  id: "items",
  switch: { label: "Items", on: true },
  place: "still",
  active: ({ setting }) => setting.items.length > 0,
  draw(pen, { setting, frame, preview }) {
    const states = frame?.items;
    setting.items.forEach(({ at, target }, i) => {
      const [x, y] = toScreen(pen.camera, ...at);
      pen.context.globalAlpha = preview ? 0.6 : 1;
      if (states?.[i] === ItemState.Destroyed) cross(pen, x, y);
      else if (!target) plus(pen, x, y);
      else if (states?.[i] === ItemState.Found) found(pen, x, y);
      else diamond(pen, x, y, states?.[i] === ItemState.Missed);
    });
    pen.context.globalAlpha = 1;
  },
};

function found({ context, colours }: Pen, x: number, y: number): void {
  context.fillStyle = colours["item-found"];
  context.beginPath();
  context.arc(x, y, half_px + 1, 0, 2 * Math.PI);
  context.fill();
  stroke(context, colours.ground, 2, [
    [x - 3, y],
    [x - 0.8, y + 2.5],
    [x + 3.2, y - 2.8],
  ]);
}

function diamond({ context, colours }: Pen, x: number, y: number, missed: boolean): void {
  const name: ColourName = missed ? "item-missed" : "item-hidden";
  const corners: [number, number][] = [
    [x, y - half_px - 1],
    [x + half_px + 1, y],
    [x, y + half_px + 1],
    [x - half_px - 1, y],
  ];
  context.fillStyle = colours.ground;
  stroke(context, colours[name], 2, corners, true);
  if (missed)
    stroke(context, colours[name], 2, [
      [x - half_px, y - half_px],
      [x + half_px, y + half_px],
    ]);
}

function plus({ context, colours }: Pen, x: number, y: number): void {
  stroke(context, colours["item-clutter"], 1.5, [
    [x - 4, y],
    [x + 4, y],
  ]);
  stroke(context, colours["item-clutter"], 1.5, [
    [x, y - 4],
    [x, y + 4],
  ]);
}

function cross({ context, colours }: Pen, x: number, y: number): void {
  stroke(context, colours["item-clutter"], 1.5, [
    [x - 4, y - 4],
    [x + 4, y + 4],
  ]);
  stroke(context, colours["item-clutter"], 1.5, [
    [x - 4, y + 4],
    [x + 4, y - 4],
  ]);
}

function stroke(
  context: CanvasRenderingContext2D,
  colour: string,
  width: number,
  points: [number, number][],
  closed = false,
): void {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  for (const [x, y] of points) context.lineTo(x, y);
  if (closed) {
    context.closePath();
    context.fill();
  }
  context.stroke();
}
