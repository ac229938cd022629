import type { MapView } from "../../api/protocol";
import { type Colours, rgb } from "../colours";
import { inWorld, type Layer, type Pen } from "./layer";

const pictures = new WeakMap<MapView, { colours: Colours; picture: HTMLCanvasElement }>();

/** Occupancy grid maps of the scenario, cell by cell. */
export const maps: Layer = {
  id: "maps",
  place: "still",
  active: ({ setting }) => setting.maps.length > 0,
  draw(pen, { setting }) {
    for (const map of setting.maps) drawMap(pen, map);
  },
};

function drawMap(pen: Pen, map: MapView): void {
  const { context, colours } = pen;
  const [origin, across, , up] = map.corners;
  const { columns, rows } = map;
  const picture = pictureOf(map, colours);
  inWorld(pen, () => {
    context.imageSmoothingEnabled = false;
    context.transform(
      (across[0] - origin[0]) / columns,
      (across[1] - origin[1]) / columns,
      (up[0] - origin[0]) / rows,
      (up[1] - origin[1]) / rows,
      origin[0],
      origin[1],
    );
    context.drawImage(picture, 0, 0);
  });
}

function pictureOf(map: MapView, colours: Colours): HTMLCanvasElement {
  const made = pictures.get(map);
  if (made?.colours === colours) return made.picture;
  const picture = document.createElement("canvas");
  [picture.width, picture.height] = [map.columns, map.rows];
  const image = new ImageData(map.columns, map.rows);
  const [unknown, occupied] = [rgb(colours.unknown), rgb(colours.obstacle)];
  const cells = atob(map.cells);
  for (let i = 0; i < cells.length; i++) {
    const cell = cells.charCodeAt(i);
    if (cell === 0) continue;
    const [red, green, blue] = cell === 2 ? occupied : unknown;
    image.data.set([red * 255, green * 255, blue * 255, 255], 4 * i);
  }
  picture.getContext("2d")?.putImageData(image, 0, 0);
  pictures.set(map, { colours, picture });
  return picture;
}
