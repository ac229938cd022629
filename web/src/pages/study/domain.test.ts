import { expect, test } from "vitest";
import type { Standing } from "../../api/study";
import { domainFor, placeOn, ticksOf } from "./domain";

const standing = (low: number | null, high: number | null, value: number | null = null): Standing => [
  0,
  1,
  value,
  low,
  high,
  null,
];

test("the axis contains all intervals and ends at round values", () => {
  expect(domainFor(null, [standing(-4.4, -2.1), standing(-1.7, -1.6)])).toEqual([-5, -1]);
  expect(domainFor(null, [standing(3.1, 3.9)])).toEqual([3, 4]);
});

test("the axis is unchanged while the intervals cover enough of it, then narrows", () => {
  const before = domainFor(null, [standing(-5, 0)]);
  expect(domainFor(before, [standing(-4, -2)])).toBe(before);
  expect(domainFor(before, [standing(-2.3, -1.4)])).toEqual([-2.4, -1.4]);
});

test("the axis grows as soon as an interval exceeds it", () => {
  const before = domainFor(null, [standing(1, 2)]);
  const [low, high] = domainFor(before, [standing(0.4, 2)]) ?? [NaN, NaN];
  expect([low <= 0.4, high >= 2]).toEqual([true, true]);
});

test("without a finite value the axis is unchanged", () => {
  expect(domainFor(null, [standing(null, null)])).toBeNull();
  expect(domainFor([0, 1], [])).toEqual([0, 1]);
});

test("intervals without width give an axis with width", () => {
  const [low, high] = domainFor(null, [standing(2, 2, 2)]) ?? [NaN, NaN];
  expect(high).toBeGreaterThan(low);
});

test("ticks are round, within the axis, and not above the maximum count", () => {
  expect(ticksOf([-5, 0], 5)).toEqual([-5, -4, -3, -2, -1, 0]);
  expect(ticksOf([0.1, 0.4], 3)).toEqual([0.1, 0.2, 0.3, 0.4]);
  expect(ticksOf([-1.52, -1.47], 2).length).toBeLessThanOrEqual(3);
});

test("positions are percentages of the axis, clamped to its ends", () => {
  expect([-2, 0, 1, 9].map((value) => placeOn([-2, 2], value))).toEqual([0, 50, 75, 100]);
});
