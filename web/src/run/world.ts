import type { Json, Point, Setting, Table } from "../net/protocol";

export interface Terrain {
  name: string;
  areas_m: Point[][];
}

export type Obstacle = { [key: string]: Json };

export interface World {
  size_m: Point;
  wraps: boolean;
  obstacles: Obstacle[];
  terrain: Terrain[];
}

/** What stands in the world, as the scenario has it. */
export function worldOf(setting: Setting): World {
  const world = tableOf(setting.document.world);
  return {
    size_m: isPoint(world.size_m) ? world.size_m : extent(setting),
    wraps: world.wraps === true,
    obstacles: listOf(world.obstacles).map(tableOf),
    terrain: Object.entries(tableOf(setting.document.terrain)).map(([name, ground]) => ({
      name,
      areas_m: listOf(tableOf(ground).areas_m).map(pointsOf),
    })),
  };
}

export function polygonOf(obstacle: Obstacle): Point[] | null {
  return "polygon_m" in obstacle ? pointsOf(obstacle.polygon_m) : null;
}

export function circleOf(obstacle: Obstacle): { at_m: Point; radius_m: number } | null {
  const { at_m, radius_m } = tableOf(obstacle.circle);
  return isPoint(at_m) && typeof radius_m === "number" ? { at_m, radius_m } : null;
}

export function tableOf(value: Json | undefined): Table {
  return typeof value === "object" && value !== null && !Array.isArray(value) ? value : {};
}

export function listOf(value: Json | undefined): Json[] {
  return Array.isArray(value) ? value : [];
}

export function pointsOf(value: Json | undefined): Point[] {
  return listOf(value).filter(isPoint);
}

export function isPoint(value: Json | undefined): value is Point {
  return Array.isArray(value) && value.length === 2 && value.every((part) => typeof part === "number");
}

/** Of a world whose scenario gives no size. */
function extent({ items }: Setting): Point {
  const most = (axis: 0 | 1) => Math.max(9, ...items.map((item) => item.at_m[axis])) + 1;
  return [most(0), most(1)];
}
