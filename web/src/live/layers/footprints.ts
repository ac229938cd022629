import type { Footprint } from "../../net/overlay";
import type { Point } from "../../net/protocol";
import { imagesOf, type Layer, type Pen, poseOf, type Scene, withinWorld } from "./layer";

/** What sensors cover, as the engine tells: filled for those that find items, outlined for all others. */
export const footprints: Layer = {
  id: "footprints",
  label: "Sensing",
  switchable: true,
  on: true,
  place: "over",
  only: "metric",
  active: ({ frame }) => (frame?.overlay?.footprints.length ?? 0) > 0,
  draw(pen, scene) {
    const [filled, outlined] = [new Path2D(), new Path2D()];
    for (const footprint of scene.frame?.overlay?.footprints ?? []) {
      const pose = poseOf(scene, footprint.robot);
      if (!pose) continue;
      for (const at of imagesOf(scene, pose.at, footprint.range_m)) {
        outline(footprint.findsItems ? filled : outlined, footprint, at, pose.heading_rad);
      }
    }
    paint(pen, scene, filled, outlined);
  },
};

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

function outline(path: Path2D, footprint: Footprint, [x, y]: Point, heading_rad: number): void {
  const { range_m, width_rad, facing_rad, ranges_m } = footprint;
  const isWhole = width_rad >= 2 * Math.PI - 1e-6;
  const parts = isWhole ? ranges_m.length : Math.max(1, ranges_m.length - 1);
  // A whole circle has its first bearing where it faces, a sector its two on the edges.
  const first = heading_rad + facing_rad - (isWhole ? 0 : width_rad / 2);
  if (isWhole)
    path.moveTo(
      x + (ranges_m[0] ?? range_m) * Math.cos(first),
      y + (ranges_m[0] ?? range_m) * Math.sin(first),
    );
  else path.moveTo(x, y);
  if (ranges_m.length === 0) path.arc(x, y, range_m, first, first + width_rad);
  ranges_m.forEach((distance_m, i) => {
    const bearing_rad = first + (i / parts) * width_rad;
    path.lineTo(x + distance_m * Math.cos(bearing_rad), y + distance_m * Math.sin(bearing_rad));
  });
  path.closePath();
}
