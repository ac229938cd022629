import type { MapPart, Point } from "../api/protocol";

export const unknown = 255;
/** At and above this percentage the robot treats a cell as occupied. */
export const occupied = 73;

/** A robot's map: one byte per cell, bottom row first. */
export class BelievedMap {
  private constructor(
    readonly corner: Point,
    readonly cell_m: number,
    readonly columns: number,
    readonly rows: number,
    readonly occupancy: Uint8Array,
    readonly unseen: Uint8Array,
  ) {}

  /** The map with a part updated. A new object, so that components notice the change. */
  static with(before: BelievedMap | null, part: MapPart): BelievedMap {
    const { corner, cell_m, columns, rows } = part;
    const isSame = before?.columns === columns && before.rows === rows;
    const cells = columns * rows;
    const occupancy = isSame ? before.occupancy : new Uint8Array(cells).fill(unknown);
    const unseen = isSame ? before.unseen : new Uint8Array(cells).fill(100);
    put(occupancy, part.occupancy, part);
    put(unseen, part.unseen, part);
    return new BelievedMap(corner, cell_m, columns, rows, occupancy, unseen);
  }

  /** Fractions of cells that are unknown, free and occupied (cells between are neither), and mean `unseen`. */
  shares(): { unknown: number; free: number; occupied: number; unseen: number } {
    const cells = this.occupancy.length;
    const share = (counts: (percent: number) => boolean) =>
      this.occupancy.reduce((sum, percent) => sum + (counts(percent) ? 1 : 0), 0) / cells;
    return {
      unknown: share((percent) => percent === unknown),
      free: share((percent) => percent < 50),
      occupied: share((percent) => percent >= occupied && percent !== unknown),
      unseen: this.unseen.reduce((sum, percent) => sum + percent, 0) / (100 * cells),
    };
  }
}

function put(cells: Uint8Array, packed: string, { columns, from, size }: MapPart): void {
  const bytes = atob(packed);
  for (let row = 0; row < size[1]; row++) {
    const first = (from[1] + row) * columns + from[0];
    for (let column = 0; column < size[0]; column++)
      cells[first + column] = bytes.charCodeAt(row * size[0] + column);
  }
}

/** Runs [column, row, columns] of the cells for which `counts` is true, row by row. */
export function runs(
  cells: Uint8Array,
  columns: number,
  counts: (value: number) => boolean,
): [number, number, number][] {
  const found: [number, number, number][] = [];
  let open: [number, number, number] | null = null;
  cells.forEach((value, cell) => {
    const column = cell % columns;
    if (column === 0 || !counts(value)) open = null;
    if (!counts(value)) return;
    if (open) open[2] += 1;
    else found.push((open = [column, Math.floor(cell / columns), 1]));
  });
  return found;
}
