import { toScreen } from "../camera";
import type { Layer } from "./layer";

const radius_px = 18;

/** A ring around the place that is marked, with a rim in the colour of the ground. */
export const place: Layer = {
  id: "place",
  place: "over",
  active: (scene) => scene.marked !== null,
  draw({ context, camera, colours }, { marked }) {
    if (!marked) return;
    context.beginPath();
    context.arc(...toScreen(camera, ...marked), radius_px, 0, 2 * Math.PI);
    for (const [colour, width] of [
      [colours.ground, 7],
      [colours.accent, 3],
    ] as const) {
      context.strokeStyle = colour;
      context.lineWidth = width;
      context.stroke();
    }
  },
};
