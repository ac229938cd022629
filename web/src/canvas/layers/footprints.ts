import type { Footprint } from "../../api/overlay";
import type { Point } from "../../api/protocol";
import { imagesOf, type Layer, type Pen, poseIn, type Scene, withinWorld } from "./layer";

/** Sensor coverage as reported by the engine: filled for item sensors, outlined for others. */
export const footprints: Layer = {
  id: "footprints",
  switch: { label: "Sensor coverage", on: true },
  place: "over",
  only: "metric",
  active: ({ frame }) => (frame?.overlay?.footprints.length ?? 0) > 0,
  draw(pen, scene) {
    const [filled, outlined] = [new Path2D(), new Path2D()];
    const overlay = scene.frame?.overlay;
    for (const footprint of overlay?.footprints ?? []) {
      // The pose at which the sensors measured: from an interpolated pose, occlusions would not match.
      const pose = poseIn(overlay?.robots ?? none, footprint.robot);
      if (!pose) continue;
      for (const at of imagesOf(scene, pose.at, footprint.range_m)) {
        outline(footprint.findsItems ? filled : outlined, footprint, at, pose.heading_rad);
      }
    }
    paint(pen, scene, filled, outlined);
  },
};

const none = new Float32Array(0);

function paint(pen: Pen, scene: Scene, filled: Path2D, outlined: Path2D): void {
  const { context, colours, camera } = pen;
  withinWorld(pen, scene, () => {
    context.globalAlpha = 0.16;
    context.fillStyle = colours["sense-items"];
    context.fill(filled);
    context.globalAlpha = 0.7;
    context.lineWidth = 1 / camera.scale;
    context.strokeStyle = colours["sense-items"];
    context.stroke(filled);
    context.setLineDash([4 / camera.scale, 4 / camera.scale]);
    context.strokeStyle = colours["sense-other"];
    context.stroke(outlined);
  });
}

const whole_rad = 2 * Math.PI - 1e-6;

function outline(path: Path2D, { corners, range_m }: Footprint, at: Point, heading_rad: number): void {
  const [first = 0, last = 0] = [corners[0], corners.at(-2)];
  // A sector is closed at the robot's position.
  if (last - first < whole_rad) path.moveTo(...at);
  else path.moveTo(...placeOf(at, heading_rad + first, corners[1] ?? 0));
  for (let i = 0; i < corners.length; i += 2) {
    const [bearing = 0, distance = 0] = [corners[i], corners[i + 1]];
    const isArc = i > 0 && distance >= range_m && (corners[i - 1] ?? 0) >= range_m;
    if (isArc) path.arc(...at, range_m, heading_rad + (corners[i - 2] ?? 0), heading_rad + bearing);
    else path.lineTo(...placeOf(at, heading_rad + bearing, distance));
  }
  path.closePath();
}

function placeOf([x, y]: Point, bearing_rad: number, distance: number): Point {
  return [x + distance * Math.cos(bearing_rad), y + distance * Math.sin(bearing_rad)];
}
