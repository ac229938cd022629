import type { Frame } from "../api/frames";
import type { Range } from "../shared/robots";
import { type Camera, toScreen } from "./camera";
import { type Colours, robotColours } from "./colours";
import { minRadius_px, type Painter } from "./painter";

/** Draws robots with Canvas 2D where WebGL2 is missing: the same shapes, up to some thousands. */
export class Painter2d implements Painter {
  readonly isSoftware = true;
  private readonly context: CanvasRenderingContext2D | null;
  private colours: Colours | null = null;
  private still: HTMLCanvasElement | null = null;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.context = canvas.getContext("2d");
  }

  setColours(colours: Colours): void {
    this.colours = colours;
  }

  setStill({ canvas }: CanvasRenderingContext2D): void {
    this.still = canvas;
  }

  paint(frame: Frame | null, ranges: Range[], camera: Camera): void {
    const { context, colours } = this;
    if (this.still) context?.drawImage(this.still, 0, 0);
    if (!frame || !context || !colours) return;
    const ratio = this.canvas.width / camera.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    // One path per state: a colour per robot would cost more than all the lines.
    robotColours.forEach((name, state) => {
      const [body, mark] = [new Path2D(), new Path2D()];
      this.gather(frame, ranges, camera, state, body, mark);
      context.fillStyle = context.strokeStyle = colours[name];
      if (state === 3) context.stroke(body);
      else context.fill(body);
      if (state === 4) context.strokeStyle = colours["robot-mark"];
      context.lineWidth = 1.5;
      context.stroke(mark);
    });
    context.setTransform(1, 0, 0, 1, 0, 0);
  }

  private gather(
    { robots, count }: Frame,
    ranges: Range[],
    camera: Camera,
    state: number,
    body: Path2D,
    mark: Path2D,
  ): void {
    for (const { kind, first, count: size } of ranges) {
      const radius = Math.max(minRadius_px(count), kind.radius * camera.scale);
      for (let i = first; i < Math.min(first + size, count); i++) {
        if (robots[4 * i + 3] !== state) continue;
        const [x, y] = toScreen(camera, robots[4 * i] ?? 0, robots[4 * i + 1] ?? 0);
        chevron(body, x, y, robots[4 * i + 2] ?? 0, radius);
        addMark(mark, state, x, y, radius);
      }
    }
  }
}

/** In screen coordinates, y down. */
export function chevron(
  path: Path2D | CanvasRenderingContext2D,
  x: number,
  y: number,
  heading: number,
  radius: number,
) {
  const [c, s] = [radius * Math.cos(heading), radius * Math.sin(heading)];
  path.moveTo(x + c, y - s);
  for (const [a, b] of [
    [-0.8, 0.7],
    [-0.4, 0],
    [-0.8, -0.7],
  ] as const) {
    path.lineTo(x + a * c - b * s, y - (a * s + b * c));
  }
  path.closePath();
}

function addMark(path: Path2D, state: number, x: number, y: number, radius: number): void {
  if (state === 1) {
    path.moveTo(x + 1.5 * radius, y);
    path.arc(x, y, 1.5 * radius, 0, 2 * Math.PI);
  } else if (state === 2) {
    const arm = 1.1 * radius;
    path.moveTo(x - arm, y - arm);
    path.lineTo(x + arm, y + arm);
    path.moveTo(x - arm, y + arm);
    path.lineTo(x + arm, y - arm);
  } else if (state === 4) {
    path.rect(x - 1.3 * radius, y - 1.3 * radius, 2.6 * radius, 2.6 * radius);
  }
}
