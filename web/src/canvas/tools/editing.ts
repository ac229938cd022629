import type { ItemView, Json, Point, Setting } from "../../api/protocol";
import { circleOf, type Obstacle, polygonOf, tableOf, type World } from "../../shared/world";
import { outline, ring } from "../layers/layer";
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
  const obstacle = world.obstacles.findLastIndex((one) => covers(one, at));
  return obstacle >= 0 ? { obstacle } : null;
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
  const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
  if (polygon) return { ...obstacle, polygon_m: polygon.map(shift) };
  return circle ? { ...obstacle, circle: { ...circle, at_m: shift(circle.at_m) } } : obstacle;
}

export function outlineOf(world: World, { items }: Setting, object: WorldObject, tolerance: number): Path2D {
  const path = new Path2D();
  if ("item" in object) {
    const item = items[object.item];
    if (item) ring(path, item.at, tolerance * 0.6);
    return path;
  }
  addObstacle(path, world.obstacles[object.obstacle] ?? {});
  return path;
}

export function addObstacle(path: Path2D, obstacle: Obstacle): void {
  const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
  if (polygon) outline(path, polygon);
  if (circle) ring(path, circle.at_m, circle.radius_m);
}

/** Such as `circle at 8, 16`. */
export function obstacleLabel(obstacle: Obstacle): string {
  const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
  if (circle) return `circle at ${circle.at_m.join(", ")}`;
  if (polygon) return `polygon at ${polygon[0]?.join(", ") ?? "–"}`;
  return `map ${String(obstacle.map ?? "")}`;
}

export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

function covers(obstacle: Obstacle, at: Point): boolean {
  const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
  return circle ? distance(circle.at_m, at) <= circle.radius_m : polygon !== null && inside(polygon, at);
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
