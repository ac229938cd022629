import type { Drive, WardenRobot } from "../../api/warden";
import { type Camera, clampScale, toScreen } from "../../canvas/camera";
import type { Colours } from "../../canvas/colours";
import { spacing } from "../../canvas/layers/grid";
import { chevron } from "../../canvas/painter_2d";

type Point = [number, number];

/** The data that the map draws. */
export interface MapScene {
  drive: Drive;
  robots: WardenRobot[];
  trails: Map<string, Point[]>;
  selected: string | undefined;
  /** A place that was clicked and not yet ordered. */
  draft: Point | null;
}

interface Pen {
  context: CanvasRenderingContext2D;
  camera: Camera;
  colours: Colours;
}

const maxTrail = 600;
const trailStep_m = 0.1;
const robotRadius_px = 11;
const margin_px = 40;
const fanHalfWidth_rad = Math.PI / 18;

/** Appends where each robot is, if it has moved. */
export function extendTrails(trails: Map<string, Point[]>, robots: WardenRobot[]): void {
  for (const { name, position } of robots) {
    if (!position) continue;
    const trail = trails.get(name) ?? [];
    const [x, y] = trail.at(-1) ?? [Infinity, Infinity];
    if (Math.hypot(position.x_m - x, position.y_m - y) < trailStep_m) continue;
    trails.set(name, [...trail, [position.x_m, position.y_m] satisfies Point].slice(-maxTrail));
  }
}

/** A view of all fences, robots and waypoints; null if there are none. */
export function fitMap({ drive, robots }: MapScene, width: number, height: number): Camera | null {
  const points = [
    ...Object.values(drive.robots).flatMap(({ fence_m }) => fence_m ?? []),
    ...robots
      .flatMap(({ position, waypoints }) => [...(position ? [position] : []), ...waypoints])
      .map(placeOf),
  ];
  if (points.length === 0) return null;
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  const [left, right] = [Math.min(...xs), Math.max(...xs)];
  const [bottom, top] = [Math.min(...ys), Math.max(...ys)];
  const [wide, high] = [Math.max(4, right - left), Math.max(4, top - bottom)];
  const scale = clampScale(Math.min((width - 2 * margin_px) / wide, (height - 2 * margin_px) / high));
  return { x: (left + right) / 2, y: (bottom + top) / 2, scale, width, height };
}

const radians = (angle_deg: number) => (angle_deg * Math.PI) / 180;

const placeOf = ({ x_m, y_m }: { x_m: number; y_m: number }): Point => [x_m, y_m];

export function drawMap(pen: Pen, scene: MapScene): void {
  const { context, camera, colours } = pen;
  context.fillStyle = colours.ground;
  context.fillRect(0, 0, camera.width, camera.height);
  context.font = "12px system-ui, sans-serif";
  drawGrid(pen);
  for (const robot of scene.robots) drawFence(pen, scene.drive.robots[robot.name]?.fence_m ?? []);
  for (const robot of scene.robots) drawTrail(pen, scene.trails.get(robot.name) ?? []);
  for (const robot of scene.robots) drawWaypoints(pen, robot);
  for (const robot of scene.robots) drawRobot(pen, scene, robot);
  if (scene.draft) drawDraft(pen, scene.draft);
}

function drawGrid({ context, camera, colours }: Pen): void {
  const step = spacing(camera.scale);
  const [halfWidth, halfHeight] = [camera.width / 2 / camera.scale, camera.height / 2 / camera.scale];
  context.strokeStyle = colours.grid;
  context.lineWidth = 1;
  context.beginPath();
  for (let x = Math.ceil((camera.x - halfWidth) / step) * step; x < camera.x + halfWidth; x += step) {
    const [px] = toScreen(camera, x, 0);
    context.moveTo(px, 0);
    context.lineTo(px, camera.height);
  }
  for (let y = Math.ceil((camera.y - halfHeight) / step) * step; y < camera.y + halfHeight; y += step) {
    const [, py] = toScreen(camera, 0, y);
    context.moveTo(0, py);
    context.lineTo(camera.width, py);
  }
  context.stroke();
  drawScale({ context, camera, colours }, step);
}

function drawScale({ context, camera, colours }: Pen, step: number): void {
  const [left, bottom] = [16, camera.height - 16];
  context.strokeStyle = context.fillStyle = colours.text;
  context.lineWidth = 1.5;
  context.strokeRect(left, bottom, step * camera.scale, 0);
  context.fillText(`${Number(step.toPrecision(3))} m`, left + 4, bottom - 6);
}

function path({ context, camera }: Pen, points: Point[]): void {
  context.beginPath();
  for (const [x, y] of points) context.lineTo(...toScreen(camera, x, y));
}

function drawFence(pen: Pen, points: Point[]): void {
  path(pen, points);
  pen.context.closePath();
  pen.context.strokeStyle = pen.colours["robot-collided"];
  pen.context.lineWidth = 1.5;
  pen.context.setLineDash([8, 5]);
  pen.context.stroke();
  pen.context.setLineDash([]);
}

function drawTrail(pen: Pen, points: Point[]): void {
  path(pen, points);
  pen.context.strokeStyle = pen.colours.trail;
  pen.context.lineWidth = 2;
  pen.context.stroke();
}

function drawWaypoints({ context, camera, colours }: Pen, { waypoints }: WardenRobot): void {
  waypoints.forEach(({ x_m, y_m, verdict }, i) => {
    const [x, y] = toScreen(camera, x_m, y_m);
    const isOver = verdict === "complete" || verdict === "impossible";
    context.strokeStyle = context.fillStyle =
      verdict === "complete"
        ? colours["item-found"]
        : verdict === "impossible"
          ? colours["item-missed"]
          : colours["item-hidden"];
    context.lineWidth = 2;
    context.beginPath();
    context.arc(x, y, 7, 0, 2 * Math.PI);
    if (isOver) context.fill();
    else context.stroke();
    context.fillStyle = colours.text;
    context.fillText(`${i + 1} ${verdict}`, x + 11, y + 4);
  });
}

function drawRobot(pen: Pen, scene: MapScene, robot: WardenRobot): void {
  const { context, camera, colours } = pen;
  if (!robot.position) return;
  const [x, y] = toScreen(camera, robot.position.x_m, robot.position.y_m);
  const heading = robot.heading && radians(robot.heading.world_deg);
  if (heading !== null) drawFans(pen, scene, robot, [x, y], heading);
  context.strokeStyle = colours.accent;
  context.lineWidth = 1;
  context.beginPath();
  context.arc(x, y, robot.position.uncertainty_m * camera.scale, 0, 2 * Math.PI);
  context.stroke();
  context.fillStyle = colours[robot.action === "move" ? "robot-clear" : "robot-collided"];
  context.beginPath();
  if (heading === null) context.arc(x, y, robotRadius_px / 2, 0, 2 * Math.PI);
  else chevron(context, x, y, heading, robotRadius_px);
  context.fill();
  context.fillStyle = colours.text;
  const isSelected = robot.name === scene.selected;
  context.font = `${isSelected ? "bold " : ""}12px system-ui, sans-serif`;
  context.fillText(robot.name, x + 14, y - 10);
  context.font = "12px system-ui, sans-serif";
}

/** What each sonar measured: a sector up to the echo, or a pale one up to its range without an echo. */
function drawFans(
  { context, camera, colours }: Pen,
  scene: MapScene,
  robot: WardenRobot,
  at: Point,
  heading: number,
) {
  const sonars = scene.drive.robots[robot.name]?.sonars ?? [];
  sonars.forEach(({ facing_deg, max_m }, i) => {
    const value_m = robot.ranges?.values_m[i];
    if (value_m === undefined || !robot.ranges?.is_known[i]) return;
    const centre = -(heading + radians(facing_deg));
    context.beginPath();
    context.moveTo(...at);
    context.arc(
      ...at,
      (value_m ?? max_m) * camera.scale,
      centre - fanHalfWidth_rad,
      centre + fanHalfWidth_rad,
    );
    context.closePath();
    context.fillStyle = colours["sense-items"];
    context.globalAlpha = value_m === null ? 0.1 : 0.35;
    context.fill();
    context.globalAlpha = 1;
  });
}

function drawDraft({ context, camera, colours }: Pen, [x_m, y_m]: Point): void {
  const [x, y] = toScreen(camera, x_m, y_m);
  context.strokeStyle = colours.accent;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(x - 9, y);
  context.lineTo(x + 9, y);
  context.moveTo(x, y - 9);
  context.lineTo(x, y + 9);
  context.stroke();
}
