import type { Point } from "../../api/protocol";
import { ring } from "../layers/layer";
import { distance, obstaclesEdit, tidy } from "./editing";
import type { Tool } from "./tool";

const usual_m = 0.5;

/** A press without a drag makes one of a usual size. */
function radiusOf(from: Point, to: Point): number {
  const drawn = distance(from, to);
  return drawn < 0.05 ? usual_m : Math.round(drawn * 100) / 100;
}

export const circle: Tool = {
  label: "Add circle",
  help: "Drag from its centre outwards.",
  grips: () => true,
  ghost(_, from, to) {
    const path = new Path2D();
    ring(path, from, radiusOf(from, to));
    return path;
  },
  edit({ world }, from, to) {
    const added = { circle: { at_m: tidy(from), radius_m: radiusOf(from, to) } };
    return obstaclesEdit([...world.obstacles, added]);
  },
};
