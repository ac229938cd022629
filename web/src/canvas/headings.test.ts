import { expect, test } from "vitest";
import type { Reach } from "../api/protocol";
import { mixed, placeOf, worths } from "./headings";

function told(...utilities: number[]): Reach {
  const courses = utilities.map((utility) => ({
    bearing_rad: 0,
    free_m: 1,
    at: [1, 0] as [number, number],
    utility,
  }));
  return { to: [3, 0], taken: 0, courses };
}

test("the best course is worth 1, the worst 0, and equal ones the same", () => {
  expect(worths(told(-1, -5, -3))).toEqual([1, 0, 0.5]);
  expect(worths(told(-2, -2))).toEqual([1, 1]);
});

test("a place before a robot's front lies in the world where the robot looks", () => {
  const pose = {
    at: [10, 5] as [number, number],
    heading_rad: Math.PI / 2,
    deviation_m: 0,
    deviation_rad: 0,
    age_s: 0,
  };
  const [x, y] = placeOf(pose, [2, 1]);
  expect(x).toBeCloseTo(9);
  expect(y).toBeCloseTo(7);
});

test("colours are mixed by shares", () => {
  expect(mixed("#000000", "#ff8000", 0.5)).toBe("rgb(128 64 0)");
  expect(mixed("#102030", "#ffffff", 0)).toBe("rgb(16 32 48)");
});
