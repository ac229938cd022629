import { expect, test } from "vitest";
import { sliderEnd } from "./slider_range";

test.each([
  [1, 0.3, 1],
  [100, 2, 100],
  [10_000, 3, 20],
  [1_000_000, 4, 20],
  [Number.POSITIVE_INFINITY, 0, 5],
  [360, 90, 360],
])("a slider up to %d that stands at %d ends at %d", (maximum, value, end) => {
  expect(sliderEnd({ maximum, value, fallback: null })).toBe(end);
});
