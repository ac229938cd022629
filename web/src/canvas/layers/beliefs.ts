import type { BelievedItem, Goal, Pose } from "../../api/protocol";
import { type Camera, toScreen } from "../camera";
import { chevron } from "../painter_2d";
import { type Layer, type Pen, poseOf } from "./layer";

const leastDeviation_px = 8;

/** What the selected robot believes and wants, dashed, as none of it need be so. */
export const mind: Layer = {
  id: "mind",
  label: "Beliefs and goals",
  switchable: true,
  on: true,
  place: "over",
  only: "metric",
  active: (scene) => !!scene.mind?.thoughts && scene.selected >= 0,
  draw(pen, scene) {
    const isOfSelected = scene.mind?.robot === scene.setting.robots[scene.selected];
    const thoughts = isOfSelected ? scene.mind?.thoughts : null;
    const pose = poseOf(scene, scene.selected);
    if (!thoughts || !pose) return;
    const { context, colours } = pen;
    context.strokeStyle = context.fillStyle = colours.belief;
    context.lineWidth = 1.5;
    context.font = "11px system-ui, sans-serif";
    goals(pen, thoughts.goals, toScreen(pen.camera, ...pose.at));
    for (const item of thoughts.items) believed(pen, item);
    if (thoughts.pose) self(pen, thoughts.pose);
  },
};

function goals({ context, camera }: Pen, wanted: Goal[], from: [number, number]): void {
  wanted.forEach((goal: Goal, i) => {
    const [x, y] = toScreen(camera, ...goal.to);
    context.globalAlpha = goal.is_pursued ? 1 : 0.5;
    context.setLineDash(goal.is_pursued ? [] : [4, 4]);
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(x, y);
    context.moveTo(x + 5, y);
    context.arc(x, y, 5, 0, 2 * Math.PI);
    context.stroke();
    context.fillText(String(i + 1), x + 8, y + 4);
  });
  context.globalAlpha = 1;
  context.setLineDash([]);
}

function believed({ context, camera }: Pen, item: BelievedItem): void {
  const [x, y] = toScreen(camera, ...item.at);
  deviation(context, camera, x, y, item.deviation_m);
  context.globalAlpha = 0.25 + 0.75 * item.confidence;
  context.fillRect(x - 3, y - 3, 6, 6);
  context.globalAlpha = 1;
  context.fillText(`${Math.round(100 * item.confidence)}%`, x + 7, y - 7);
}

function self({ context, camera }: Pen, pose: Pose): void {
  const [x, y] = toScreen(camera, ...pose.at);
  deviation(context, camera, x, y, pose.deviation_m);
  context.beginPath();
  chevron(context, x, y, pose.heading_rad, 9);
  context.stroke();
}

/** Two standard deviations, the same along each axis. */
function deviation(
  context: CanvasRenderingContext2D,
  { scale }: Camera,
  x: number,
  y: number,
  deviation_m: number,
) {
  context.setLineDash([3, 3]);
  context.beginPath();
  context.arc(x, y, Math.max(leastDeviation_px, 2 * deviation_m * scale), 0, 2 * Math.PI);
  context.stroke();
  context.setLineDash([]);
}
