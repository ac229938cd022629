import { type BelievedMap, runs, unknown } from "../../shared/believed_map";
import { type Colours, rgb } from "../colours";
import { inWorld, type Layer, type Pen } from "./layer";

/** What was made of a map: each map is drawn many times. */
interface Made {
  colours: Colours;
  filled: HTMLCanvasElement;
  unseen: HTMLCanvasElement;
  /** Cells of which nothing is known, in cells from the corner. */
  dark: Path2D;
}

const made = new WeakMap<BelievedMap, Made>();

/** The selected robot's map over the truth: hatched is unknown, filled cells are full, free ones clear. */
export const beliefMap: Layer = {
  id: "belief-map",
  label: "Believed map",
  switchable: true,
  on: true,
  place: "over",
  only: "metric",
  active: ({ map, selected }) => map !== null && selected >= 0,
  draw(pen, { map }) {
    if (!map) return;
    const { filled, dark } = madeOf(map, pen.colours);
    hatch(pen, map, dark);
    picture(pen, map, filled);
  },
};

/** Where the selected robot has not looked well enough to know that nothing is there. */
export const unseen: Layer = {
  id: "unseen",
  label: "Not yet searched",
  switchable: true,
  on: false,
  place: "over",
  only: "metric",
  active: ({ map, selected }) => map !== null && selected >= 0,
  draw(pen, { map }) {
    if (map) picture(pen, map, madeOf(map, pen.colours).unseen);
  },
};

function madeOf(map: BelievedMap, colours: Colours): Made {
  const known = made.get(map);
  if (known?.colours === colours) return known;
  const dark = new Path2D();
  for (const [column, row, length] of runs(map.occupancy, map.columns, (percent) => percent === unknown))
    dark.rect(column, row, length, 1);
  const filled = raster(map, map.occupancy, colours.belief, filledAlpha);
  const notSeen = raster(map, map.unseen, colours["item-hidden"], (percent) => 0.22 * (percent / 100));
  const all = { colours, filled, unseen: notSeen, dark };
  made.set(map, all);
  return all;
}

/** What is rather filled than free is the fuller the surer it is. */
function filledAlpha(percent: number): number {
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

/** Lines as far from each other at every zoom. */
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

/** A square with lines from corner to corner, which go on in the next. */
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
