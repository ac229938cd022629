import { type BelievedMap, runs, unknown } from "../../shared/believed_map";
import { type Colours, rgb } from "../colours";
import { inWorld, type Layer, type Pen } from "./layer";

/** Rasters of a map, cached because each map is drawn many times. */
interface Rasters {
  colours: Colours;
  occupied: HTMLCanvasElement;
  unseen: HTMLCanvasElement;
  /** Unknown cells, in units of cells from the corner. */
  dark: Path2D;
}

const cache = new WeakMap<BelievedMap, Rasters>();

/** The selected robot's map over the true world: unknown cells are hatched, occupied ones filled, free ones clear. */
export const beliefMap: Layer = {
  id: "belief-map",
  switch: { label: "Believed map", on: true },
  place: "over",
  only: "metric",
  active: ({ map, selected }) => map !== null && selected >= 0,
  draw(pen, { map }) {
    if (!map) return;
    const { occupied, dark } = rastersOf(map, pen.colours);
    hatch(pen, map, dark);
    picture(pen, map, occupied);
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
    if (map) picture(pen, map, rastersOf(map, pen.colours).unseen);
  },
};

function rastersOf(map: BelievedMap, colours: Colours): Rasters {
  const known = cache.get(map);
  if (known?.colours === colours) return known;
  const dark = new Path2D();
  for (const [column, row, length] of runs(map.occupancy, map.columns, (percent) => percent === unknown))
    dark.rect(column, row, length, 1);
  const occupied = raster(map, map.occupancy, colours.belief, occupiedAlpha);
  const notSeen = raster(map, map.unseen, colours["item-hidden"], (percent) => 0.22 * (percent / 100));
  const all = { colours, occupied, unseen: notSeen, dark };
  cache.set(map, all);
  return all;
}

/** Cells that are probably occupied: the higher the probability, the more opaque. */
function occupiedAlpha(percent: number): number {
  return percent === unknown || percent <= 50 ? 0 : 0.15 + (0.5 * (percent - 50)) / 50;
}

function raster(
  { columns, rows }: BelievedMap,
  cells: Uint8Array,
  colour: string,
  alpha: (value: number) => number,
): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [columns, rows];
  const image = new ImageData(columns, rows);
  const [red, green, blue] = rgb(colour);
  cells.forEach((value, i) => {
    image.data.set([red * 255, green * 255, blue * 255, alpha(value) * 255], 4 * i);
  });
  canvas.getContext("2d")?.putImageData(image, 0, 0);
  return canvas;
}

function picture(pen: Pen, { corner, cell_m }: BelievedMap, cells: HTMLCanvasElement): void {
  inWorld(pen, () => {
    pen.context.imageSmoothingEnabled = false;
    pen.context.transform(cell_m, 0, 0, cell_m, ...corner);
    pen.context.drawImage(cells, 0, 0);
  });
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
