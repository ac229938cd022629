import type { Point } from "../../api/protocol";
import { outline } from "../layers/layer";
import { obstaclesEdit, rounded } from "./editing";
import type { Tool } from "./tool";

const minSide_m = 0.05;

function corners([ax, ay]: Point, [bx, by]: Point): Point[] {
  const all: Point[] = [
    [ax, ay],
    [bx, ay],
    [bx, by],
    [ax, by],
  ];
  return all.map(rounded);
}

export const rectangle: Tool = {
  label: "Add rectangle",
  help: "Drag from corner to corner.",
  canStart: () => true,
  preview(_, from, to) {
    const path = new Path2D();
    outline(path, corners(from, to));
    return path;
  },
  edit({ world }, from, to) {
    const isFlat = Math.abs(from[0] - to[0]) < minSide_m || Math.abs(from[1] - to[1]) < minSide_m;
    return isFlat ? null : obstaclesEdit([...world.obstacles, { polygon_m: corners(from, to) }]);
  },
};
