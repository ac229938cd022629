import type { Frame } from "../../api/frames";
import type { Engine, Mind, Point, RobotView, Setting } from "../../api/protocol";
import type { BelievedMap } from "../../shared/believed_map";
import type { World } from "../../shared/world";
import type { Camera } from "../camera";
import type { Colours } from "../colours";
import type { Trails } from "./trail_store";

/** All that layers draw. */
export interface Scene {
  setting: Setting;
  world: World;
  frame: Frame | null;
  mind: Mind | null;
  /** What the selected robot believes of its field. */
  map: BelievedMap | null;
  /** What else is told of the selected robot. */
  told: RobotView | null;
  /** Number of the selected robot; -1 for none. */
  selected: number;
  trails: Trails;
  /** What is being put somewhere by hand, drawn above all. */
  ghost: Path2D | null;
}

export interface Pen {
  context: CanvasRenderingContext2D;
  camera: Camera;
  colours: Colours;
}

/**
 * Something to draw. `still` layers, beneath the robots, are drawn anew only when view, setting or items
 * change; those `over` the robots with each frame.
 */
export interface Layer {
  id: string;
  label: string;
  /** Whether people can switch it, and how it begins. */
  switchable: boolean;
  on: boolean;
  place: "still" | "over";
  /** The engine that alone has such things; left out: all have. */
  only?: Engine;
  /** Whether there is anything to draw; a canvas with nothing on it costs nothing. */
  active(scene: Scene): boolean;
  draw(pen: Pen, scene: Scene): void;
}

/** Draws in the world's unit, y up, in which a line of a pixel is `1 / camera.scale` wide. */
export function inWorld({ context, camera }: Pen, draw: () => void): void {
  const { x, y, scale, width, height } = camera;
  context.save();
  context.transform(scale, 0, 0, -scale, width / 2 - x * scale, height / 2 + y * scale);
  draw();
  context.restore();
}

/** The same, and nothing beyond the border: nothing is there, or it is at the other side of a world that wraps. */
export function withinWorld(pen: Pen, { world: { size } }: Scene, draw: () => void): void {
  inWorld(pen, () => {
    pen.context.beginPath();
    pen.context.rect(0, 0, ...size);
    pen.context.clip();
    draw();
  });
}

/** Where a place is, and in a world that wraps its images that are within `reach` of the world too. */
export function imagesOf({ world }: Scene, [x, y]: Point, reach: number): Point[] {
  if (!world.periodic) return [[x, y]];
  const [xs, ys] = [along(x, world.size[0], reach), along(y, world.size[1], reach)];
  return xs.flatMap((x) => ys.map((y): Point => [x, y]));
}

function along(at: number, size: number, reach: number): number[] {
  return [at, at - size, at + size].filter((image) => image >= -reach && image <= size + reach);
}

export function outline(path: Path2D, points: Point[]): void {
  points.forEach(([x, y], i) => {
    if (i === 0) path.moveTo(x, y);
    else path.lineTo(x, y);
  });
  path.closePath();
}

export function ring(path: Path2D, [x, y]: Point, radius: number): void {
  path.moveTo(x + radius, y);
  path.arc(x, y, radius, 0, 2 * Math.PI);
}

export interface Pose {
  at: Point;
  heading_rad: number;
}

/** Where a robot is; null if there is no such robot. */
export function poseOf({ frame }: Scene, robot: number): Pose | null {
  return frame && poseIn(frame.robots, robot);
}

/** The same of robots as a frame has them. */
export function poseIn(robots: Float32Array, robot: number): Pose | null {
  const [x, y, heading_rad] = robot < 0 ? [] : robots.subarray(4 * robot, 4 * robot + 3);
  return x === undefined || y === undefined || heading_rad === undefined ? null : { at: [x, y], heading_rad };
}
