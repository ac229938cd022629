import { type Colours, rgb } from "../colours";
import { inWorld, type Pen } from "./layer";

/** Cells of one byte each, the row at the origin first. */
export interface Cells {
  columns: number;
  rows: number;
  bytes: ArrayLike<number>;
}

/** Where a picture is drawn: its first cell's corner, and how far a column and a row are apart, in the world. */
export interface Place {
  origin: readonly [number, number];
  column: readonly [number, number];
  row: readonly [number, number];
}

/** Pictures of cells, each made once for what it shows and theme. */
export class Pictures<Shown extends object> {
  private readonly made = new WeakMap<Shown, { colours: Colours; canvas: HTMLCanvasElement }>();

  /** `colourOf` is the red, green, blue and opacity of a byte, 0 to 255. */
  constructor(
    private readonly cellsOf: (shown: Shown) => Cells,
    private readonly colourOf: (colours: Colours, shown: Shown) => (byte: number) => readonly number[],
  ) {}

  of(shown: Shown, colours: Colours): HTMLCanvasElement {
    const known = this.made.get(shown);
    if (known?.colours === colours) return known.canvas;
    const canvas = pictureOf(this.cellsOf(shown), this.colourOf(colours, shown));
    this.made.set(shown, { colours, canvas });
    return canvas;
  }
}

function pictureOf({ columns, rows, bytes }: Cells, colourOf: (byte: number) => readonly number[]) {
  const palette = Array.from({ length: 256 }, (_, byte) => colourOf(byte));
  const image = new ImageData(columns, rows);
  for (let i = 0; i < bytes.length; i++) image.data.set(palette[bytes[i] ?? 0] ?? [], 4 * i);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [columns, rows];
  canvas.getContext("2d")?.putImageData(image, 0, 0);
  return canvas;
}

/** The channels of an opaque or translucent colour, 0 to 255. */
export function channelsOf(colour: string, opacity = 1): number[] {
  return [...rgb(colour), opacity].map((channel) => 255 * channel);
}

export function drawPicture(pen: Pen, picture: HTMLCanvasElement, { origin, column, row }: Place): void {
  inWorld(pen, () => {
    pen.context.imageSmoothingEnabled = false;
    pen.context.transform(...column, ...row, ...origin);
    pen.context.drawImage(picture, 0, 0);
  });
}

/** The place of square cells along the axes. */
export function squares(origin: readonly [number, number], side: number): Place {
  return { origin, column: [side, 0], row: [0, side] };
}

/** The bytes of a base64 string. */
export function bytesOf(packed: string): Uint8Array {
  return Uint8Array.from(atob(packed), (character) => character.charCodeAt(0));
}
