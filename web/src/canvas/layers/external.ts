import type { Point } from "../../api/protocol";
import { externalOf, kindOf } from "../../shared/robots";
import { toScreen } from "../camera";
import { drawnRadius } from "../painter";
import { type Layer, poseOf, ring } from "./layer";

const gap_px = 5;
const tick_px = 6;

/** A ring with four ticks around each robot with an external body, a real robot: no other mark has them. */
export const external: Layer = {
  id: "external",
  place: "over",
  only: "metric",
  active: ({ setting }) => setting.external.length > 0,
  draw({ context, camera, colours }, scene) {
    const path = new Path2D();
    for (const robot of externalOf(scene.setting)) {
      const pose = poseOf(scene, robot);
      if (!pose) continue;
      const radius = kindOf(scene.setting, robot)?.radius ?? 0;
      const drawn = drawnRadius(radius, camera, scene.setting.robots.length) * camera.scale;
      addRing(path, toScreen(camera, ...pose.at), drawn * 1.3 + gap_px);
    }
    // The rim stands out from what is drawn below.
    for (const [colour, width] of [
      [colours.ground, 5],
      [colours.text, 2.5],
    ] as const) {
      context.strokeStyle = colour;
      context.lineWidth = width;
      context.stroke(path);
    }
  },
};

function addRing(path: Path2D, [x, y]: Point, radius: number): void {
  ring(path, [x, y], radius);
  for (const [right, down] of [
    [1, 0],
    [0, 1],
    [-1, 0],
    [0, -1],
  ] as const) {
    path.moveTo(x + right * radius, y + down * radius);
    path.lineTo(x + right * (radius + tick_px), y + down * (radius + tick_px));
  }
}
