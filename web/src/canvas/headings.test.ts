import { expect, test } from "vitest";
import type { HeadingOptions } from "../api/protocol";
import { mixColours, relativeUtilities, toWorldFrame } from "./headings";

function options(...utilities: number[]): HeadingOptions {
  const headings = utilities.map((utility) => ({
    bearing_rad: 0,
    free_m: 1,
    at: [1, 0] as [number, number],
    utility,
  }));
  return { to: [3, 0], chosen: 0, headings };
}

test("utilities are scaled from 0 to 1, and equal ones are 1", () => {
  expect(relativeUtilities(options(-1, -5, -3))).toEqual([1, 0, 0.5]);
  expect(relativeUtilities(options(-2, -2))).toEqual([1, 1]);
});

test("a point ahead of a robot lies in its heading direction", () => {
  const pose = {
    at: [10, 5] as [number, number],
    heading_rad: Math.PI / 2,
    deviation_m: 0,
    deviation_rad: 0,
    age_s: 0,
  };
  const [x, y] = toWorldFrame(pose, [2, 1]);
  expect(x).toBeCloseTo(9);
  expect(y).toBeCloseTo(7);
});

test("colours are interpolated", () => {
  expect(mixColours("#000000", "#ff8000", 0.5)).toBe("rgb(128 64 0)");
  expect(mixColours("#102030", "#ffffff", 0)).toBe("rgb(16 32 48)");
});
