import { expect, test } from "vitest";
import { areNumbers, cellWords, columnsOf, quantileWords } from "./columns";

test("what is judged comes first, and what names a run is no column", () => {
  const run = { run: "3", quantile: 0.5, found: 4, failed: false, time_s: 3, merit: -1 };
  expect(columnsOf([run])).toEqual(["merit", "time_s", "failed", "found"]);
  expect(columnsOf([])).toEqual([]);
});

test("numbers are as exact as they are read", () => {
  expect([-1.238, 28.31, 51319.8, 3, -4, null, true].map(cellWords)).toEqual([
    "−1.24",
    "28.3",
    "51,320",
    "3",
    "−4",
    "–",
    "yes",
  ]);
});

test("the ends and the middle of a sample have names", () => {
  expect([0, 0.125, 0.5, 1].map(quantileWords)).toEqual(["worst", "13%", "median", "best"]);
});

test("columns of numbers are told from columns of words", () => {
  expect(areNumbers(["−2.55 (−3.23 to −1.87)", "12,345", "0.26%", "–"])).toBe(true);
  expect(areNumbers(["1,234", "out after 27 runs"])).toBe(false);
  expect(areNumbers([])).toBe(false);
});
