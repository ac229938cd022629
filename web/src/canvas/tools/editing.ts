import type { ItemView, Json, Point, Setting } from "../../api/protocol";
import { circleOf, type Obstacle, polygonOf, tableOf, type World } from "../../shared/world";
import { outline, ring } from "../layers/layer";
import type { Bench, Edit } from "./tool";

/** Something that can be moved or removed: the place of an obstacle or item in its list. */
export type Thing = { obstacle: number } | { item: number };

/** Finer than this nobody places by hand. */
const millimetre = (value: number) => Math.round(value * 1000) / 1000;

export function tidy([x, y]: Point): Point {
  return [millimetre(x), millimetre(y)];
}

/** The thing at a place: an item before an obstacle, as items are small. */
export function thingAt({ setting, world, reach }: Bench, at: Point): Thing | null {
  const item = setting.items.findIndex((each) => distance(each.at, at) <= reach);
  if (item >= 0) return { item };
  const obstacle = world.obstacles.findLastIndex((one) => covers(one, at));
  return obstacle >= 0 ? { obstacle } : null;
}

export function obstaclesEdit(list: Obstacle[]): Edit {
  return { path: "world.obstacles", value: list };
}

/** Puts all items of a kind at given places, from now on. */
export function itemsEdit(setting: Setting, kind: string, places: Point[]): Edit {
  const before = tableOf(tableOf(setting.document.items)[kind]);
  const placement: Json = { kind: "fixed", at_m: places.map(tidy) };
  // Count and places in one change: apart, one of them would be refused.
  return { path: `items.${kind}`, value: { ...before, count: places.length, placement } };
}

export function placesOf(setting: Setting, kind: string, but: ItemView | null = null): Point[] {
  return setting.items.filter((item) => item.kind === kind && item !== but).map((item) => item.at);
}

export function moved(obstacle: Obstacle, dx: number, dy: number): Obstacle {
  const shift = ([x, y]: Point) => tidy([x + dx, y + dy]);
  const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
  if (polygon) return { ...obstacle, polygon_m: polygon.map(shift) };
  return circle ? { ...obstacle, circle: { ...circle, at_m: shift(circle.at_m) } } : obstacle;
}

export function pathOf(world: World, { items }: Setting, thing: Thing, reach: number): Path2D {
  const path = new Path2D();
  if ("item" in thing) {
    const item = items[thing.item];
    if (item) ring(path, item.at, reach * 0.6);
    return path;
  }
  addObstacle(path, world.obstacles[thing.obstacle] ?? {});
  return path;
}

export function addObstacle(path: Path2D, obstacle: Obstacle): void {
  const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
  if (polygon) outline(path, polygon);
  if (circle) ring(path, circle.at_m, circle.radius_m);
}

/** Such as `circle at 8, 16`. */
export function obstacleWords(obstacle: Obstacle): string {
  const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
  if (circle) return `circle at ${circle.at_m.join(", ")}`;
  if (polygon) return `polygon at ${polygon[0]?.join(", ") ?? "no place"}`;
  return `map ${String(obstacle.map ?? "")}`;
}

export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

function covers(obstacle: Obstacle, at: Point): boolean {
  const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
  return circle ? distance(circle.at_m, at) <= circle.radius_m : polygon !== null && inside(polygon, at);
}

/** Whether a ray from a place crosses the outline an odd number of times. */
function inside(polygon: Point[], [x, y]: Point): boolean {
  let odd = false;
  polygon.forEach(([ax, ay], i) => {
    const [bx, by] = polygon.at(i - 1) ?? [ax, ay];
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) odd = !odd;
  });
  return odd;
}
