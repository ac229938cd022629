import type { Point } from "../../api/protocol";
import { ring } from "../layers/layer";
import { distance, obstaclesEdit, rounded } from "./editing";
import type { Tool } from "./tool";

const defaultRadius_m = 0.5;

/** A click without a drag gives the default radius. */
function radiusOf(from: Point, to: Point): number {
  const drawn = distance(from, to);
  return drawn < 0.05 ? defaultRadius_m : Math.round(drawn * 100) / 100;
}

export const circle: Tool = {
  label: "Add circle",
  help: "Drag from the centre outwards.",
  canStart: () => true,
  preview(_, from, to) {
    const path = new Path2D();
    ring(path, from, radiusOf(from, to));
    return path;
  },
  edit({ world }, from, to) {
    const added = { circle: { at_m: rounded(from), radius_m: radiusOf(from, to) } };
    return obstaclesEdit([...world.obstacles, added]);
  },
};
