import type { MapView, Point } from "../../api/protocol";
import { bytesOf, channelsOf, drawPicture, Pictures } from "./cells";
import type { Layer, Pen } from "./layer";

const [unknown, occupied] = [1, 2];
const clear = [0, 0, 0, 0];

const pictures = new Pictures<MapView>(
  ({ columns, rows, cells }) => ({ columns, rows, bytes: bytesOf(cells) }),
  (colours) => {
    const filled = new Map([
      [unknown, channelsOf(colours.unknown)],
      [occupied, channelsOf(colours.obstacle)],
    ]);
    return (byte) => filled.get(byte) ?? clear;
  },
);

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
  const [origin, across, , up] = map.corners;
  const away = ([x, y]: Point, cells: number): Point => [(x - origin[0]) / cells, (y - origin[1]) / cells];
  const place = { origin, column: away(across, map.columns), row: away(up, map.rows) };
  drawPicture(pen, pictures.of(map, pen.colours), place);
}
