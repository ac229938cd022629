import type { Point, VehicleView } from "../../api/protocol";
import { hasPassage } from "../../shared/passage";
import { toScreen } from "../camera";
import { inWorld, type Layer, type Pen } from "./layer";

/** The path on which vehicles are to pass a lane: a band of its width. */
export const passagePath: Layer = {
  id: "passage",
  switch: { label: "Passage", on: true },
  place: "still",
  only: "metric",
  offered: hasPassage,
  active: ({ lane }) => lane?.passage != null,
  draw(pen, { lane }) {
    if (!lane?.passage) return;
    const { path, width_m } = lane.passage;
    const { context, camera, colours } = pen;
    const [[left, low] = [0, 0], [right, high] = [0, 0]] = lane.corners;
    inWorld(pen, () => {
      context.beginPath();
      context.rect(left, low, right - left, high - low);
      context.clip();
      // The ends are round, and cut by the sides of the lane.
      context.lineJoin = context.lineCap = "round";
      context.strokeStyle = colours.accent;
      context.globalAlpha = 0.3;
      stroke(context, path, width_m);
      context.globalAlpha = 1;
      context.setLineDash([6 / camera.scale, 4 / camera.scale]);
      context.lineCap = "butt";
      stroke(context, path, 1.5 / camera.scale);
    });
  },
};

/** The vehicles that pass the lane: discs as wide as the path; those that were destroyed are crossed out. */
export const passageVehicles: Layer = {
  id: "vehicles",
  switch: { label: "Vehicles", on: true },
  place: "over",
  only: "metric",
  offered: hasPassage,
  active: ({ vehicles }) => vehicles.some(({ has_entered }) => has_entered),
  draw(pen, { lane, vehicles }) {
    const radius = Math.max(5, ((lane?.passage?.width_m ?? 0) / 2) * pen.camera.scale);
    for (const vehicle of vehicles) if (vehicle.has_entered) drawVehicle(pen, vehicle, radius);
  },
};

function drawVehicle({ context, camera, colours }: Pen, { at, status }: VehicleView, radius: number): void {
  const [x, y] = toScreen(camera, ...at);
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = status === "lost" ? colours["robot-broken"] : colours.accent;
  context.globalAlpha = 0.75;
  context.fill();
  context.globalAlpha = 1;
  context.lineWidth = 2;
  context.strokeStyle = colours.text;
  context.stroke();
  if (status !== "lost") return;
  const arm = radius * Math.SQRT1_2;
  context.beginPath();
  for (const up of [arm, -arm]) {
    context.moveTo(x - arm, y - up);
    context.lineTo(x + arm, y + up);
  }
  context.stroke();
}

function stroke(context: CanvasRenderingContext2D, path: Point[], width: number): void {
  context.lineWidth = width;
  context.beginPath();
  path.forEach((at, i) => {
    if (i === 0) context.moveTo(...at);
    else context.lineTo(...at);
  });
  context.stroke();
}
