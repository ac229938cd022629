import { expect, test } from "vitest";
import { type Camera, fitTo, pan, toScreen, toWorld, zoomAt } from "./camera";

const camera: Camera = { x: 12, y: 7, scale: 20, width: 640, height: 480 };

test("screen and world coordinates are inverses", () => {
  const [px, py] = toScreen(camera, 3.5, 9.25);
  const [x, y] = toWorld(camera, px, py);
  expect(x).toBeCloseTo(3.5, 10);
  expect(y).toBeCloseTo(9.25, 10);
});

test("y goes up in the world and down on the screen", () => {
  expect(toScreen(camera, 0, 8)[1]).toBeLessThan(toScreen(camera, 0, 7)[1]);
});

test.each([
  [100, 50, 1.5],
  [600, 470, 0.2],
  [0, 0, 1e6],
  [320, 240, 1e-9],
])("zooming at (%d, %d) by %d keeps the point under the pointer", (px, py, factor) => {
  const before = toWorld(camera, px, py);
  const after = toWorld(zoomAt(camera, px, py, factor), px, py);
  expect(after[0]).toBeCloseTo(before[0], 8);
  expect(after[1]).toBeCloseTo(before[1], 8);
});

test("panning moves a point with the pointer", () => {
  const before = toScreen(camera, 1, 2);
  const after = toScreen(pan(camera, 15, -40), 1, 2);
  expect(after[0] - before[0]).toBeCloseTo(15, 8);
  expect(after[1] - before[1]).toBeCloseTo(-40, 8);
});

test.each([
  [[25, 25], 800, 600],
  [[60, 40], 320, 500],
  [[1000, 1], 360, 360],
] as const)("fitting %s into %d by %d pixels shows all of it", (world, width, height) => {
  const fitted = fitTo([world[0], world[1]], width, height);
  const [left, bottom] = toScreen(fitted, 0, 0);
  const [right, top] = toScreen(fitted, world[0], world[1]);
  expect(Math.min(left, top)).toBeGreaterThanOrEqual(0);
  expect(right).toBeLessThanOrEqual(width);
  expect(bottom).toBeLessThanOrEqual(height);
});
