import type { SensorView } from "../../net/protocol";
import { rangesOf } from "../../run/robots";
import { inWorld, type Layer, type Pen, poseOf, type Scene } from "./layer";

/** Of more robots than this only the selected one's are drawn: a picture full of them says nothing. */
const most = 300;

/** What sensors see: filled for those that find items, outlined for all others. */
export const footprints: Layer = {
  id: "footprints",
  label: "Sensing",
  switchable: true,
  on: true,
  place: "over",
  only: "metric",
  active: ({ frame, selected, setting }) =>
    setting.kinds.some((kind) => kind.sensors.length > 0) &&
    frame !== null &&
    (frame.count <= most || selected >= 0),
  draw(pen, scene) {
    const [filled, outlined] = [new Path2D(), new Path2D()];
    for (const { kind, first, count } of rangesOf(scene.setting)) {
      for (let robot = first; robot < first + count; robot++) {
        if (robot !== scene.selected && (scene.frame?.count ?? 0) > most) continue;
        for (const sensor of kind.sensors) {
          // Only the selected robot's other sensors, whose circles would cover each other.
          if (sensor.kind === "items") sector(filled, scene, robot, sensor);
          else if (robot === scene.selected) sector(outlined, scene, robot, sensor);
        }
      }
    }
    paint(pen, filled, outlined);
  },
};

function paint(pen: Pen, filled: Path2D, outlined: Path2D): void {
  const { context, colours, camera } = pen;
  inWorld(pen, () => {
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

function sector(
  path: Path2D,
  scene: Scene,
  robot: number,
  { range_m, width_rad, facing_rad }: SensorView,
): void {
  const pose = poseOf(scene, robot);
  if (!pose) return;
  const [x, y] = pose.at;
  const middle = pose.heading_rad + facing_rad;
  const [from, to] = [middle - width_rad / 2, middle + width_rad / 2];
  const whole = width_rad >= 2 * Math.PI - 1e-6;
  if (whole) path.moveTo(x + range_m * Math.cos(from), y + range_m * Math.sin(from));
  else path.moveTo(x, y);
  path.arc(x, y, range_m, from, to);
  path.closePath();
}
