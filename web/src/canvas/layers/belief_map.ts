import { type BelievedMap, runs, unknown } from "../../shared/believed_map";
import type { Colours } from "../colours";
import { type Cells, channelsOf, drawPicture, Pictures, squares } from "./cells";
import type { Layer, Pen } from "./layer";

/** The selected robot's map over the true world: unknown cells are hatched, occupied ones filled, free ones clear. */
export const beliefMap: Layer = {
  id: "belief-map",
  switch: { label: "Believed map", on: true },
  place: "over",
  only: "metric",
  active: ({ map, selected }) => map !== null && selected >= 0,
  draw(pen, { map }) {
    if (!map) return;
    hatch(pen, map, unknownCells(map));
    drawCells(pen, map, occupiedCells);
  },
};

/** Where the selected robot may have missed an item. */
export const unseen: Layer = {
  id: "unseen",
  switch: { label: "Unsearched area", on: false },
  place: "over",
  only: "metric",
  active: ({ map, selected }) => map !== null && selected >= 0,
  draw(pen, { map }) {
    if (map) drawCells(pen, map, unsearchedCells);
  },
};

/** Cells that are probably occupied: the higher the probability, the more opaque. */
function occupiedAlpha(percent: number): number {
  return percent === unknown || percent <= 50 ? 0 : 0.15 + (0.5 * (percent - 50)) / 50;
}

function cellsOf(bytes: "occupancy" | "unseen") {
  return (map: BelievedMap): Cells => ({ columns: map.columns, rows: map.rows, bytes: map[bytes] });
}

const occupiedCells = new Pictures(
  cellsOf("occupancy"),
  (colours) => (percent) => channelsOf(colours.belief, occupiedAlpha(percent)),
);
const unsearchedCells = new Pictures(
  cellsOf("unseen"),
  (colours) => (percent) => channelsOf(colours["item-hidden"], 0.22 * (percent / 100)),
);

function drawCells(pen: Pen, map: BelievedMap, pictures: Pictures<BelievedMap>): void {
  drawPicture(pen, pictures.of(map, pen.colours), squares(map.corner, map.cell_m));
}

const paths = new WeakMap<BelievedMap, Path2D>();

/** The unknown cells, in units of cells from the corner. */
function unknownCells(map: BelievedMap): Path2D {
  const known = paths.get(map);
  if (known) return known;
  const path = new Path2D();
  for (const [column, row, length] of runs(map.occupancy, map.columns, (percent) => percent === unknown))
    path.rect(column, row, length, 1);
  paths.set(map, path);
  return path;
}

/** Hatching with the same spacing at every zoom. */
function hatch({ context, camera, colours }: Pen, { corner, cell_m }: BelievedMap, cells: Path2D): void {
  const { x, y, scale, width, height } = camera;
  const size = cell_m * scale;
  const [left, bottom] = [width / 2 + (corner[0] - x) * scale, height / 2 - (corner[1] - y) * scale];
  const onScreen = new Path2D();
  onScreen.addPath(cells, new DOMMatrix([size, 0, 0, -size, left, bottom]));
  context.globalAlpha = 0.4;
  context.fillStyle = context.createPattern(tile(colours), "repeat") ?? colours.unknown;
  context.fill(onScreen);
  context.globalAlpha = 1;
}

const tiles = new WeakMap<Colours, HTMLCanvasElement>();
const tile_px = 8;

/** A tile with diagonal lines that continue in the next. */
function tile(colours: Colours): HTMLCanvasElement {
  const known = tiles.get(colours);
  if (known) return known;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = tile_px;
  const context = canvas.getContext("2d");
  if (context) {
    context.strokeStyle = colours.border;
    context.beginPath();
    for (const from of [-tile_px, 0, tile_px]) {
      context.moveTo(from - 1, tile_px + 1);
      context.lineTo(from + tile_px + 1, -1);
    }
    context.stroke();
  }
  tiles.set(colours, canvas);
  return canvas;
}
