import type { Point } from "../api/protocol";

/** The view of the world: centre, scale in pixels per unit of the world, and size in pixels. */
export interface Camera {
  x: number;
  y: number;
  scale: number;
  width: number;
  height: number;
}

const minScale = 1e-3;
const maxScale = 5000;
const marginPx = 24;

export function clampScale(scale: number): number {
  return Math.min(maxScale, Math.max(minScale, scale));
}

export function toScreen(camera: Camera, x: number, y: number): Point {
  return [
    (x - camera.x) * camera.scale + camera.width / 2,
    (camera.y - y) * camera.scale + camera.height / 2,
  ];
}

export function toWorld(camera: Camera, px: number, py: number): Point {
  return [
    (px - camera.width / 2) / camera.scale + camera.x,
    camera.y - (py - camera.height / 2) / camera.scale,
  ];
}

/** The whole world, with a margin. */
export function fitTo(world: Point, width: number, height: number): Camera {
  const scale = Math.min((width - 2 * marginPx) / world[0], (height - 2 * marginPx) / world[1]);
  return { x: world[0] / 2, y: world[1] / 2, scale: clampScale(scale), width, height };
}

/** Zooms by `factor`, keeping the point under the pixel fixed. */
export function zoomAt(camera: Camera, px: number, py: number, factor: number): Camera {
  const [x, y] = toWorld(camera, px, py);
  const scale = clampScale(camera.scale * factor);
  return {
    ...camera,
    scale,
    x: x - (px - camera.width / 2) / scale,
    y: y + (py - camera.height / 2) / scale,
  };
}

/** Moves the view by a number of pixels. */
export function pan(camera: Camera, dx: number, dy: number): Camera {
  return { ...camera, x: camera.x - dx / camera.scale, y: camera.y + dy / camera.scale };
}

/** The whole world in a view of another size, if it was displayed before; otherwise the same centre. */
export function resizeIn(world: Point, camera: Camera, width: number, height: number): Camera {
  const { x, y, scale } = fitTo(world, camera.width, camera.height);
  const isFitted = camera.x === x && camera.y === y && camera.scale === scale;
  return isFitted ? fitTo(world, width, height) : resize(camera, width, height);
}

/** The same centre in a view of another size. */
export function resize(camera: Camera, width: number, height: number): Camera {
  return { ...camera, width, height };
}
