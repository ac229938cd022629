import { toScreen } from "../camera";
import type { Layer, Pen, Scene } from "./layer";

const minSpacing_px = 64;

/** Grid spacing in the unit of the world: 1, 2 or 5 times a power of ten, at least `minSpacing_px` wide. */
export function spacing(scale: number): number {
  const wanted = minSpacing_px / scale;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return ([1, 2, 5, 10].find((factor) => factor * power >= wanted) ?? 10) * power;
}

export const grid: Layer = {
  id: "grid",
  switch: { label: "Grid and scale", on: true },
  place: "still",
  active: () => true,
  draw(pen, scene) {
    const { context, colours, camera } = pen;
    const marks = spacing(camera.scale);
    const step = scene.world.cell ?? marks;
    context.strokeStyle = colours.grid;
    context.lineWidth = 1;
    context.beginPath();
    for (let x = step; x < scene.world.size[0]; x += step) line(pen, scene, x, true);
    for (let y = step; y < scene.world.size[1]; y += step) line(pen, scene, y, false);
    context.stroke();
    scaleBar(pen, marks, scene.world.unit);
  },
};

function line({ context, camera }: Pen, { world }: Scene, at: number, upright: boolean): void {
  const [from, to] = upright
    ? [toScreen(camera, at, 0), toScreen(camera, at, world.size[1])]
    : [toScreen(camera, 0, at), toScreen(camera, world.size[0], at)];
  const snap = (value: number) => Math.round(value) + 0.5;
  context.moveTo(upright ? snap(from[0]) : from[0], upright ? from[1] : snap(from[1]));
  context.lineTo(upright ? snap(to[0]) : to[0], upright ? to[1] : snap(to[1]));
}

function scaleBar({ context, camera, colours }: Pen, step: number, unit: string): void {
  const [left, bottom, length] = [16, camera.height - 16, step * camera.scale];
  context.strokeStyle = context.fillStyle = colours.text;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(left, bottom - 5);
  context.lineTo(left, bottom);
  context.lineTo(left + length, bottom);
  context.lineTo(left + length, bottom - 5);
  context.stroke();
  context.font = "12px system-ui, sans-serif";
  context.fillText(`${Number(step.toPrecision(3))} ${unit}`, left + 5, bottom - 6);
}
