import type { Frame } from "../../api/frames";
import type { Engine, Inspection, ObstacleView, Point, RobotView, Setting, Shown } from "../../api/protocol";
import type { BelievedMap } from "../../shared/believed_map";
import type { World } from "../../shared/world";
import type { Camera } from "../camera";
import type { Colours } from "../colours";
import type { Trails } from "./trail_store";

/** The data that layers draw. */
export interface Scene {
  setting: Setting;
  world: World;
  frame: Frame | null;
  inspection: Inspection | null;
  /** The believed map of the selected robot. */
  map: BelievedMap | null;
  /** The layers that the server has sent; null if there are none. */
  shown: Shown | null;
  /** The engine's report about the selected robot. */
  robot: RobotView | null;
  /** Number of the selected robot; -1 for none. */
  selected: number;
  trails: Trails;
  /** The place that is marked; null for none. */
  marked: Point | null;
  /** The shape that the current tool would place, drawn on top. */
  preview: Path2D | null;
}

export interface Pen {
  context: CanvasRenderingContext2D;
  camera: Camera;
  colours: Colours;
}

/**
 * A layer of the drawing. `still` layers, below the robots, are redrawn only when view, setting or items
 * change; layers `over` the robots with each frame.
 */
export interface Layer {
  id: string;
  /** The switch that users have for it, and its initial state; without one, the layer is always on. */
  switch?: { label: string; on: boolean };
  place: "still" | "over";
  /** The only engine that has this layer; left out: both. */
  only?: Engine;
  /** Whether there is anything to draw; an empty canvas is hidden, which costs nothing. */
  active(scene: Scene): boolean;
  draw(pen: Pen, scene: Scene): void;
}

/** Draws in world coordinates, y up; one pixel is `1 / camera.scale`. */
export function inWorld({ context, camera }: Pen, draw: () => void): void {
  const { x, y, scale, width, height } = camera;
  context.save();
  context.transform(scale, 0, 0, -scale, width / 2 - x * scale, height / 2 + y * scale);
  draw();
  context.restore();
}

/** As `inWorld`, clipped to the world. In a periodic world, what crosses the border is drawn at the other side. */
export function withinWorld(pen: Pen, { world: { size } }: Scene, draw: () => void): void {
  inWorld(pen, () => {
    pen.context.beginPath();
    pen.context.rect(0, 0, ...size);
    pen.context.clip();
    draw();
  });
}

/** A point and, in a periodic world, its images within `reach` of the world. */
export function imagesOf({ world }: Scene, [x, y]: Point, reach: number): Point[] {
  if (!world.periodic) return [[x, y]];
  const [xs, ys] = [along(x, world.size[0], reach), along(y, world.size[1], reach)];
  return xs.flatMap((x) => ys.map((y): Point => [x, y]));
}

function along(at: number, size: number, reach: number): number[] {
  return [at, at - size, at + size].filter((image) => image >= -reach && image <= size + reach);
}

/** The way from one point to another; in a periodic world the shortest, which may cross the border. */
export function shortestWay({ world: { size, periodic } }: Scene, from: Point, to: Point): Point {
  return [0, 1].map((axis) => {
    const way = (to[axis] ?? 0) - (from[axis] ?? 0);
    const side = size[axis] ?? 1;
    return periodic ? way - side * Math.round(way / side) : way;
  }) as Point;
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

/** Adds an obstacle, moved by [dx, dy]. */
export function shape(path: Path2D, { polygon, circle }: ObstacleView, [dx, dy]: Point = [0, 0]): void {
  const there = ([x, y]: Point): Point => [x + dx, y + dy];
  if (polygon) outline(path, polygon.map(there));
  if (circle) ring(path, there(circle.at), circle.radius);
}

export interface Pose {
  at: Point;
  heading_rad: number;
}

/** The pose of a robot; null if there is no such robot. */
export function poseOf({ frame }: Scene, robot: number): Pose | null {
  return frame && poseIn(frame.robots, robot);
}

/** As `poseOf`, from the robots of a frame. */
export function poseIn(robots: Float32Array, robot: number): Pose | null {
  const [x, y, heading_rad] = robot < 0 ? [] : robots.subarray(4 * robot, 4 * robot + 3);
  return x === undefined || y === undefined || heading_rad === undefined ? null : { at: [x, y], heading_rad };
}
