import { expect, test } from "vitest";
import { fitTo } from "./camera";
import { drawnRadius } from "./painter";

const large = fitTo([300, 300], 900, 700);

test.each([
  [1, 7],
  [200, 7],
  [201, 4],
  [2001, 3],
])(
  "one of %i robots of 0.15 m in a world of 300 m is drawn with a radius of %i pixels",
  (robots, radius_px) => {
    expect(drawnRadius(0.15, large, robots) * large.scale).toBeCloseTo(radius_px);
  },
);

test("a robot that is larger on the screen is drawn to scale", () => {
  expect(drawnRadius(0.15, fitTo([3, 3], 900, 700), 1)).toBe(0.15);
});
