import { externalOf, kindOf } from "../../shared/robots";
import { toScreen } from "../camera";
import { drawnRadius } from "../painter";
import { type Layer, poseOf } from "./layer";

/** A dashed ring around each robot with an external body: a real robot. */
export const external: Layer = {
  id: "external",
  place: "over",
  only: "metric",
  active: ({ setting }) => setting.external.length > 0,
  draw({ context, camera, colours }, scene) {
    context.strokeStyle = colours.text;
    context.lineWidth = 1.5;
    context.setLineDash([4, 3]);
    for (const robot of externalOf(scene.setting)) {
      const pose = poseOf(scene, robot);
      if (!pose) continue;
      const radius = kindOf(scene.setting, robot)?.radius ?? 0;
      const drawn = drawnRadius(radius, camera, scene.setting.robots.length) * camera.scale;
      context.beginPath();
      context.arc(...toScreen(camera, ...pose.at), drawn * 1.3 + 5, 0, 2 * Math.PI);
      context.stroke();
    }
  },
};
