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

test("a picture of nothing but plain colours needs no tile", () => {
  expect(stripsOf(picture(96, 64, []), ground, white, grey)).toEqual([]);
});

test("each pixel of another colour is in a tile, and neighbours make one strip", () => {
  const strips = stripsOf(
    picture(96, 64, [
      [20, 20],
      [40, 30],
      [70, 63],
    ]),
    ground,
    white,
    grey,
  );
  expect(strips).toEqual([
    [16, 16, 32, 16],
    [64, 48, 16, 16],
  ]);
});

test("tiles that cross the ground's edge are drawn, as they have two colours", () => {
  const crossing: Box = [8, 16, 72, 32];
  expect(stripsOf(picture(96, 64, []), crossing, white, grey)).toEqual([
    [0, 16, 16, 16],
    [0, 32, 16, 16],
  ]);
});

test("tiles at the edge are as small as what is left of the picture", () => {
  expect(stripsOf(picture(90, 50, [[89, 49]]), ground, white, grey)).toEqual([[80, 48, 10, 2]]);
});
