import type { ItemView, Json, ObstacleView, Point, Setting } from "../../api/protocol";
import {
  circleOf,
  isPoint,
  type Obstacle,
  polygonOf,
  rectangleOf,
  tableOf,
  type World,
} from "../../shared/world";
import { ring, shape } from "../layers/layer";
import type { EditContext, Edit } from "./tool";

/** An object that can be moved or removed: the index of an obstacle or item. */
export type WorldObject = { obstacle: number } | { item: number };

/** The precision of editing by hand. */
const millimetre = (value: number) => Math.round(value * 1000) / 1000;

export function rounded([x, y]: Point): Point {
  return [millimetre(x), millimetre(y)];
}

/** The object at a point: items take precedence over obstacles, as they are small. */
export function objectAt({ setting, world, tolerance }: EditContext, at: Point): WorldObject | null {
  const item = setting.items.findIndex((each) => distance(each.at, at) <= tolerance);
  if (item >= 0) return { item };
  const found = world.shapes.findLast((one) => covers(one, at));
  return found ? { obstacle: found.entry } : null;
}

export function obstaclesEdit(list: Obstacle[]): Edit {
  return { path: "world.obstacles", value: list };
}

/** Fixes all items of a kind at given positions. */
export function itemsEdit(setting: Setting, kind: string, places: Point[]): Edit {
  const before = tableOf(tableOf(setting.document.items)[kind]);
  const placement: Json = { kind: "fixed", at_m: places.map(rounded) };
  // Count and positions must change together; one alone would be invalid.
  return { path: `items.${kind}`, value: { ...before, count: places.length, placement } };
}

export function positionsOf(setting: Setting, kind: string, but: ItemView | null = null): Point[] {
  return setting.items.filter((item) => item.kind === kind && item !== but).map((item) => item.at);
}

export function moved(obstacle: Obstacle, dx: number, dy: number): Obstacle {
  const shift = ([x, y]: Point) => rounded([x + dx, y + dy]);
  const [polygon, circle, rectangle] = [polygonOf(obstacle), circleOf(obstacle), rectangleOf(obstacle)];
  if (polygon) return { ...obstacle, polygon_m: polygon.map(shift) };
  if (isPoint(rectangle?.at_m))
    return { ...obstacle, rectangle: { ...rectangle, at_m: shift(rectangle.at_m) } };
  return circle ? { ...obstacle, circle: { ...circle, at_m: shift(circle.at_m) } } : obstacle;
}

export function outlineOf(world: World, { items }: Setting, object: WorldObject, tolerance: number): Path2D {
  const path = new Path2D();
  if ("item" in object) {
    const item = items[object.item];
    if (item) ring(path, item.at, tolerance * 0.6);
    return path;
  }
  addObstacle(path, world, object.obstacle);
  return path;
}

/** Adds all copies of an obstacle, moved by [dx, dy]. */
export function addObstacle(path: Path2D, world: World, entry: number, by?: Point): void {
  for (const one of world.shapes) if (one.entry === entry) shape(path, one, by);
}

/** Such as `circle at 8, 16` or `26 rectangles from 3, 4`. */
export function obstacleLabel({ obstacles, shapes }: World, entry: number): string {
  const obstacle = obstacles[entry] ?? {};
  const [polygon, circle, rectangle] = [polygonOf(obstacle), circleOf(obstacle), rectangleOf(obstacle)];
  if (!polygon && !circle && !rectangle) return `map ${String(obstacle.map ?? "")}`;
  const name = polygon ? "polygon" : circle ? "circle" : "rectangle";
  const at = polygon?.[0] ?? circle?.at_m ?? rectangle?.at_m;
  const place = isPoint(at) ? at.join(", ") : "–";
  const copies = shapes.filter((one) => one.entry === entry).length;
  return copies > 1 ? `${copies} ${name}s from ${place}` : `${name} at ${place}`;
}

export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

function covers({ polygon, circle }: ObstacleView, at: Point): boolean {
  return circle ? distance(circle.at, at) <= circle.radius : polygon !== null && inside(polygon, at);
}

/** Ray casting: whether a ray from the point crosses the outline an odd number of times. */
function inside(polygon: Point[], [x, y]: Point): boolean {
  let odd = false;
  polygon.forEach(([ax, ay], i) => {
    const [bx, by] = polygon.at(i - 1) ?? [ax, ay];
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) odd = !odd;
  });
  return odd;
}
