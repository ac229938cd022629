import type { BelievedItem, Goal, Pose } from "../../api/protocol";
import { type Camera, toScreen } from "../camera";
import { chevron } from "../painter_2d";
import { type Layer, type Pen, poseOf } from "./layer";

const minDeviation_px = 8;

/** Beliefs and goals of the selected robot, dashed because they may differ from the truth. */
export const beliefs: Layer = {
  id: "beliefs",
  switch: { label: "Beliefs and goals", on: true },
  place: "over",
  only: "metric",
  active: (scene) => !!scene.inspection?.belief_state && scene.selected >= 0,
  draw(pen, scene) {
    const isOfSelected = scene.inspection?.robot === scene.setting.robots[scene.selected];
    const beliefState = isOfSelected ? scene.inspection?.belief_state : null;
    const pose = poseOf(scene, scene.selected);
    if (!beliefState || !pose) return;
    const { context, colours } = pen;
    context.strokeStyle = context.fillStyle = colours.belief;
    context.lineWidth = 1.5;
    context.font = "11px system-ui, sans-serif";
    drawGoals(pen, beliefState.goals, toScreen(pen.camera, ...pose.at));
    for (const item of beliefState.items) drawItem(pen, item);
    if (beliefState.pose) drawPose(pen, beliefState.pose);
  },
};

function drawGoals({ context, camera }: Pen, goals: Goal[], from: [number, number]): void {
  goals.forEach((goal: Goal, i) => {
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

function drawItem({ context, camera }: Pen, item: BelievedItem): void {
  const [x, y] = toScreen(camera, ...item.at);
  deviation(context, camera, x, y, item.deviation_m);
  context.globalAlpha = 0.25 + 0.75 * item.confidence;
  context.fillRect(x - 3, y - 3, 6, 6);
  context.globalAlpha = 1;
  context.fillText(`${Math.round(100 * item.confidence)}%`, x + 7, y - 7);
}

function drawPose({ context, camera }: Pen, pose: Pose): void {
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
  context.arc(x, y, Math.max(minDeviation_px, 2 * deviation_m * scale), 0, 2 * Math.PI);
  context.stroke();
  context.setLineDash([]);
}
