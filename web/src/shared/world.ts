import type { Json, ObstacleView, Point, Setting, Table, WorldView } from "../api/protocol";

export interface Terrain {
  name: string;
  areas_m: Point[][];
}

/** An obstacle of the scenario, of which there may be copies. */
export type Obstacle = { [key: string]: Json };

/** The world of a setting, with obstacles and terrain. */
export interface World extends WorldView {
  obstacles: Obstacle[];
  /** The obstacles other than maps, with all copies. */
  shapes: ObstacleView[];
  terrain: Terrain[];
}

export function worldOf(setting: Setting): World {
  const world = tableOf(setting.document.world);
  return {
    ...setting.world,
    obstacles: listOf(world.obstacles).map(tableOf),
    shapes: setting.obstacles,
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

export function rectangleOf(obstacle: Obstacle): Table | null {
  return "rectangle" in obstacle ? tableOf(obstacle.rectangle) : null;
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
