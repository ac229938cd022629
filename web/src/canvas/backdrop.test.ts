import { expect, test } from "vitest";
import { type Box, packed, stripsOf } from "./backdrop";

const [white, grey] = [packed([1, 1, 1]), packed([0.5, 0.5, 0.5])];
const ground: Box = [16, 16, 64, 32];

function picture(width: number, height: number, spots: [number, number][]) {
  const data = new Uint8ClampedArray(4 * width * height);
  const pixels = new Uint32Array(data.buffer);
  const inGround = (x: number, y: number) => x >= 16 && x < 80 && y >= 16 && y < 48;
  for (let i = 0; i < pixels.length; i++)
    pixels[i] = inGround(i % width, Math.floor(i / width)) ? white : grey;
  for (const [x, y] of spots) pixels[y * width + x] = 1;
  return { width, height, data };
}

test("a picture of plain colours needs no tiles", () => {
  expect(stripsOf(picture(96, 64, []), ground, white, grey)).toEqual([]);
});

test("each pixel of another colour is in a tile, and adjacent tiles are merged", () => {
  const spots: [number, number][] = [
    [20, 20],
    [24, 21],
    [20, 24],
    [24, 27],
    [70, 63],
  ];
  expect(stripsOf(picture(96, 64, spots), ground, white, grey)).toEqual([
    [20, 20, 8, 8],
    [68, 60, 4, 4],
  ]);
});

test("a line across the whole picture is one box", () => {
  const line = Array.from({ length: 64 }, (_, y): [number, number] => [40, y]);
  expect(stripsOf(picture(96, 64, line), ground, white, grey)).toEqual([[40, 0, 4, 64]]);
});

test("tiles that cross the edge of the ground are drawn", () => {
  const crossing: Box = [14, 16, 66, 32];
  expect(stripsOf(picture(96, 64, []), crossing, white, grey)).toEqual([[12, 16, 4, 32]]);
});

test("tiles at the edge are cut to the picture", () => {
  expect(stripsOf(picture(90, 50, [[89, 49]]), ground, white, grey)).toEqual([[88, 48, 2, 2]]);
});
