import type { LaneView, MarkView, Point } from "../../api/protocol";
import {
  borderOf,
  cellsOf,
  hasLane,
  isBelievedMine,
  type MarkState,
  shadeOf,
  stateOf,
} from "../../shared/lane";
import { toScreen } from "../camera";
import { type Colours, rgb } from "../colours";
import { inWorld, type Layer, type Pen } from "./layer";

/** The remaining risk in each cell, in the colour scale of the legend. */
export const laneRisk: Layer = {
  id: "lane-risk",
  switch: { label: "Remaining risk", on: true },
  place: "still",
  only: "metric",
  offered: hasLane,
  active: ({ lane }) => lane !== null,
  draw(pen, { lane }) {
    if (!lane) return;
    inCells(pen, lane, (context) => {
      context.imageSmoothingEnabled = false;
      context.drawImage(rasterOf(lane, pen.colours), 0, 0);
    });
    frame(pen, lane);
  },
};

/** The cells that are cleared: hatched, with an outline. */
export const lanePath: Layer = {
  id: "lane-path",
  switch: { label: "Cleared path", on: true },
  place: "still",
  only: "metric",
  offered: hasLane,
  active: ({ lane }) => lane !== null,
  draw(pen, { lane }) {
    if (!lane) return;
    const { context, camera, colours } = pen;
    context.strokeStyle = colours.cleared;
    context.lineWidth = 2 / (camera.scale * lane.cell_m);
    context.lineCap = "square";
    inCells(pen, lane, () => {
      context.beginPath();
      for (const [from, to] of borderOf(lane)) {
        context.moveTo(...from);
        context.lineTo(...to);
      }
      context.stroke();
    });
  },
};

/** The marks: a shape for each state, larger the more probable a mine is; believed mines are filled. */
export const laneMarks: Layer = {
  id: "lane-marks",
  switch: { label: "Marks", on: true },
  place: "over",
  only: "metric",
  offered: hasLane,
  active: ({ lane }) => lane !== null && lane.marks.length > 0,
  draw(pen, { lane }) {
    const marks = [...(lane?.marks ?? [])].sort((a, b) => a.mine - b.mine);
    for (const mark of marks) drawMark(pen, mark);
  },
};

/** The shape of each state within a unit circle: closed polygons, or lines. */
const shapes: Record<MarkState, { closed: boolean; lines: Point[][] }> = {
  unverified: { closed: true, lines: [polygon(24)] },
  confirmed: { closed: true, lines: [polygon(3)] },
  rejected: {
    closed: false,
    lines: [
      [
        [-0.8, -0.8],
        [0.8, 0.8],
      ],
      [
        [-0.8, 0.8],
        [0.8, -0.8],
      ],
    ],
  },
  neutralised: {
    closed: false,
    lines: [
      [
        [-0.9, 0],
        [-0.3, 0.7],
        [0.9, -0.8],
      ],
    ],
  },
  isolated: { closed: true, lines: [polygon(6)] },
  missed: { closed: true, lines: [polygon(4)] },
};

/** A regular polygon with a corner at the top. */
function polygon(corners: number): Point[] {
  return Array.from({ length: corners }, (_, i): Point => {
    const angle = (2 * Math.PI * i) / corners;
    return [Math.sin(angle), -Math.cos(angle)];
  });
}

function drawMark({ context, camera, colours }: Pen, mark: MarkView): void {
  const [x, y] = toScreen(camera, ...mark.at);
  const state = stateOf(mark);
  const radius = state === "neutralised" || state === "rejected" ? 6 : 4 + 4 * Math.sqrt(mark.mine);
  const { closed, lines } = shapes[state];
  context.beginPath();
  for (const points of lines) {
    points.forEach(([right, down], i) => {
      const at: Point = [x + radius * right, y + radius * down];
      if (i === 0) context.moveTo(...at);
      else context.lineTo(...at);
    });
    if (closed) context.closePath();
  }
  const isMine = isBelievedMine(mark);
  context.lineJoin = context.lineCap = "round";
  context.strokeStyle = colours.ground;
  context.lineWidth = isMine ? 6 : 4.5;
  context.stroke();
  if (closed) {
    context.fillStyle = isMine ? colours["item-missed"] : colours.ground;
    context.fill();
  }
  context.strokeStyle = colours.text;
  context.lineWidth = isMine ? 2.5 : 1.8;
  context.stroke();
}

const rasters = new WeakMap<LaneView, { colours: Colours; canvas: HTMLCanvasElement }>();

function rasterOf(lane: LaneView, colours: Colours): HTMLCanvasElement {
  const known = rasters.get(lane);
  if (known?.colours === colours) return known.canvas;
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [lane.columns, lane.rows];
  const image = new ImageData(lane.columns, lane.rows);
  const palette = Array.from({ length: 256 }, (_, byte) => colourAt(colours, shadeOf(lane.scale, byte)));
  cellsOf(lane).forEach((byte, i) => image.data.set([...(palette[byte] ?? [0, 0, 0]), 255], 4 * i));
  canvas.getContext("2d")?.putImageData(image, 0, 0);
  rasters.set(lane, { colours, canvas });
  return canvas;
}

/** The colour at a place of the scale, 0 to 1, each channel 0 to 255. */
function colourAt(colours: Colours, place: number): number[] {
  const stops = ["risk-1", "risk-2", "risk-3", "risk-4", "risk-5"] as const;
  const along = place * (stops.length - 1);
  const first = Math.min(Math.floor(along), stops.length - 2);
  const [low, high] = [stops[first], stops[first + 1]].map((name) => rgb(colours[name ?? "risk-1"]));
  return [0, 1, 2].map((channel) => {
    const [from, to] = [low?.[channel] ?? 0, high?.[channel] ?? 0];
    return 255 * (from + (along - first) * (to - from));
  });
}

/** Draws in units of cells from the lower left corner, within the lane: its last cells may reach beyond it. */
function inCells(pen: Pen, lane: LaneView, draw: (context: CanvasRenderingContext2D) => void): void {
  const [[left, low], size] = boxOf(lane);
  inWorld(pen, () => {
    const { context } = pen;
    context.beginPath();
    context.rect(left, low, ...size);
    context.clip();
    context.transform(lane.cell_m, 0, 0, lane.cell_m, left, low);
    draw(context);
  });
}

function frame(pen: Pen, lane: LaneView): void {
  const [corner, size] = boxOf(lane);
  inWorld(pen, () => {
    pen.context.strokeStyle = pen.colours.border;
    pen.context.lineWidth = 1 / pen.camera.scale;
    pen.context.strokeRect(...corner, ...size);
  });
}

/** The lower left corner of the lane, and its width and height. */
function boxOf({ corners }: LaneView): [Point, Point] {
  const [low = [0, 0], high = [0, 0]] = corners;
  return [low, [high[0] - low[0], high[1] - low[1]]];
}
