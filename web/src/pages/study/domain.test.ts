import { expect, test } from "vitest";
import type { Standing } from "../../api/study";
import { domainFor, placeOn, ticksOf } from "./domain";

const standing = (low: number | null, high: number | null, value: number | null = null): Standing => [
  0,
  1,
  value,
  low,
  high,
];

test("the axis holds all intervals, and ends at round values", () => {
  expect(domainFor(null, [standing(-4.4, -2.1), standing(-1.7, -1.6)])).toEqual([-5, -1]);
  expect(domainFor(null, [standing(3.1, 3.9)])).toEqual([3, 4]);
});

test("the axis stays as long as the intervals are large enough on it, then it is looked at more closely", () => {
  const before = domainFor(null, [standing(-5, 0)]);
  expect(domainFor(before, [standing(-4, -2)])).toBe(before);
  expect(domainFor(before, [standing(-2.3, -1.4)])).toEqual([-2.4, -1.4]);
});

test("the axis grows at once when an interval leaves it", () => {
  const before = domainFor(null, [standing(1, 2)]);
  const [low, high] = domainFor(before, [standing(0.4, 2)]) ?? [NaN, NaN];
  expect([low <= 0.4, high >= 2]).toEqual([true, true]);
});

test("without a finite value the axis is as it was", () => {
  expect(domainFor(null, [standing(null, null)])).toBeNull();
  expect(domainFor([0, 1], [])).toEqual([0, 1]);
});

test("intervals of no width have an axis of some", () => {
  const [low, high] = domainFor(null, [standing(2, 2, 2)]) ?? [NaN, NaN];
  expect(high).toBeGreaterThan(low);
});

test("ticks are round, within the axis, and no more than asked", () => {
  expect(ticksOf([-5, 0], 5)).toEqual([-5, -4, -3, -2, -1, 0]);
  expect(ticksOf([0.1, 0.4], 3)).toEqual([0.1, 0.2, 0.3, 0.4]);
  expect(ticksOf([-1.52, -1.47], 2).length).toBeLessThanOrEqual(3);
});

test("places are percents of the axis, and what is beyond lies at its end", () => {
  expect([-2, 0, 1, 9].map((value) => placeOn([-2, 2], value))).toEqual([0, 50, 75, 100]);
});
