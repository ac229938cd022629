import { kindOf } from "../../shared/robots";
import { toScreen } from "../camera";
import { drawnRadius } from "../painter";
import { type Layer, poseOf } from "./layer";

/** Four corners around the selected robot, to be distinct from the ring of a collision warning. */
export const selection: Layer = {
  id: "selection",
  place: "over",
  active: ({ selected }) => selected >= 0,
  draw({ context, camera, colours }, scene) {
    const pose = poseOf(scene, scene.selected);
    if (!pose) return;
    const radius = kindOf(scene.setting, scene.selected)?.radius ?? 0;
    const half = drawnRadius(radius, camera, scene.setting.robots.length) * camera.scale * 1.6 + 4;
    const [x, y] = toScreen(camera, ...pose.at);
    context.strokeStyle = colours.accent;
    context.lineWidth = 2;
    context.beginPath();
    for (const [dx, dy] of [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ] as const) {
      context.moveTo(x + dx * half, y + dy * half * 0.5);
      context.lineTo(x + dx * half, y + dy * half);
      context.lineTo(x + dx * half * 0.5, y + dy * half);
    }
    context.stroke();
  },
};
