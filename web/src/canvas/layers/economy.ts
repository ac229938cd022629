import type { ControllerView, GoalView, Point } from "../../api/protocol";
import { colourOf, hasEconomy, reasonLabel } from "../../shared/economy";
import { toScreen } from "../camera";
import type { Pen, Scene } from "./layer";
import { imagesOf, inWorld, type Layer, poseOf, ring, shortestWay, withinWorld } from "./layer";

const radius_px = 5;
const font = "12px system-ui, sans-serif";
/** With more, the labels would hide each other: the panel lists all. */
const maxReasons = 12;

/**
 * Goals in the colour of the controller that owns them, with a line from the robot that each is awarded to, and
 * controllers with the range of their radio. With a controller chosen, those of others are faint.
 */
export const economy: Layer = {
  id: "economy",
  switch: { label: "Goals and controllers", on: true },
  place: "over",
  only: "metric",
  offered: hasEconomy,
  active: ({ economy }) => economy !== null,
  draw(pen, scene) {
    const { goals, controllers } = scene.economy ?? { goals: [], controllers: [] };
    for (const controller of controllers) drawRange(pen, scene, controller);
    for (const goal of goals) drawLine(pen, scene, goal);
    for (const goal of goals) drawGoal(pen, scene, goal);
    const hopeless = goals.filter(({ unserved }) => unserved !== null);
    if (hopeless.length <= maxReasons)
      for (const { at, owner, unserved } of hopeless) {
        style(pen, scene, owner);
        label(pen, at, reasonLabel(unserved ?? ""), radius_px + 4);
      }
    for (const controller of controllers) drawController(pen, scene, controller);
  },
};

function style({ context, colours }: Pen, scene: Scene, owner: string | null): void {
  const number = colourOf(scene.economy?.controllers ?? [], owner);
  const colour = number === null ? colours.border : colours[`owner-${number}` as keyof typeof colours];
  context.strokeStyle = context.fillStyle = colour;
  context.globalAlpha = scene.controller === null || scene.controller === owner ? 1 : 0.25;
}

function drawLine(pen: Pen, scene: Scene, { at, owner, robot, status }: GoalView): void {
  const number = robot === null || status !== "awarded" ? -1 : scene.setting.robots.indexOf(robot);
  const pose = poseOf(scene, number);
  if (!pose) return;
  const { context, camera } = pen;
  const [x, y] = shortestWay(scene, pose.at, at);
  style(pen, scene, owner);
  context.lineWidth = (number === scene.selected ? 3 : 1.5) / camera.scale;
  withinWorld(pen, scene, () => {
    context.beginPath();
    for (const [startX, startY] of imagesOf(scene, pose.at, Math.max(Math.abs(x), Math.abs(y)))) {
      context.moveTo(startX, startY);
      context.lineTo(startX + x, startY + y);
    }
    context.stroke();
  });
}

/** A ring while open, a disc in it when awarded, a tick when served, a cross when expired, a dot until issued. */
function drawGoal(pen: Pen, scene: Scene, { at, owner, status, unserved }: GoalView): void {
  const { context, camera, colours } = pen;
  const [x, y] = toScreen(camera, ...at);
  style(pen, scene, owner);
  context.lineWidth = 2;
  if (status === "served" || status === "expired") {
    context.strokeStyle = status === "served" ? colours["item-found"] : colours["item-missed"];
    const tick: Point[] = [
      [x - 4, y],
      [x - 1, y + 3],
      [x + 4, y - 4],
    ];
    lines(context, status === "served" ? [tick] : crossed(x, y));
    return;
  }
  const { fillStyle } = context;
  disc(
    context,
    x,
    y,
    status === "pending" ? 2 : radius_px,
    status === "pending" ? fillStyle : colours.ground,
  );
  if (status === "pending") return;
  context.stroke();
  if (status === "awarded") disc(context, x, y, 2.5, fillStyle);
  if (unserved !== null) lines(context, crossed(x, y));
}

function drawRange(pen: Pen, scene: Scene, controller: ControllerView): void {
  if (!controller.is_working) return;
  const { context, camera } = pen;
  style(pen, scene, controller.name);
  context.globalAlpha *= 0.6;
  context.lineWidth = 1.5 / camera.scale;
  context.setLineDash([6 / camera.scale, 5 / camera.scale]);
  inWorld(pen, () => {
    const path = new Path2D();
    ring(path, placeOf(scene, controller), controller.range_m);
    context.stroke(path);
  });
  context.setLineDash([]);
}

/** A square with its name; crossed if it has failed. */
function drawController(pen: Pen, scene: Scene, controller: ControllerView): void {
  const { context, camera, colours } = pen;
  const at = placeOf(scene, controller);
  const [x, y] = toScreen(camera, ...at);
  const half = controller.name === scene.controller ? 9 : 7;
  style(pen, scene, controller.name);
  context.fillRect(x - half, y - half, 2 * half, 2 * half);
  context.strokeStyle = colours.ground;
  context.lineWidth = 2;
  context.strokeRect(x - half, y - half, 2 * half, 2 * half);
  if (!controller.is_working) lines(context, crossed(x, y));
  label(pen, at, controller.is_working ? controller.name : `${controller.name}, failed`, half + 5);
}

/** The place of a controller: that of the robot that carries it, which moves between two messages. */
function placeOf(scene: Scene, { at, aboard }: ControllerView): Point {
  const number = aboard === null ? -1 : scene.setting.robots.indexOf(aboard);
  return poseOf(scene, number)?.at ?? at;
}

function label({ context, camera, colours }: Pen, at: Point, text: string, right_px: number): void {
  const [x, y] = toScreen(camera, ...at);
  context.font = font;
  context.textBaseline = "middle";
  context.lineWidth = 4;
  context.lineJoin = "round";
  context.strokeStyle = colours.ground;
  context.strokeText(text, x + right_px, y);
  context.fillStyle = colours.text;
  context.fillText(text, x + right_px, y);
}

function disc(context: CanvasRenderingContext2D, x: number, y: number, radius: number, fill: Fill): void {
  context.fillStyle = fill;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}

type Fill = CanvasRenderingContext2D["fillStyle"];

function crossed(x: number, y: number): Point[][] {
  return [-1, 1].map((side): Point[] => [
    [x - 4, y - 4 * side],
    [x + 4, y + 4 * side],
  ]);
}

function lines(context: CanvasRenderingContext2D, each: Point[][]): void {
  context.beginPath();
  for (const points of each)
    points.forEach((at, i) => (i === 0 ? context.moveTo(...at) : context.lineTo(...at)));
  context.stroke();
}
