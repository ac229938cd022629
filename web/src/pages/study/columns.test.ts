import { expect, test } from "vitest";
import { areNumbers, cellText, columnsOf, quantileText } from "./columns";

test("columns of the merit come first, and the run number is not a column", () => {
  const run = { run: "3", quantile: 0.5, found: 4, failed: false, time_s: 3, merit: -1 };
  expect(columnsOf([run])).toEqual(["merit", "time_s", "failed", "found"]);
  expect(columnsOf([{ run: "3", missed_mine: 1, found_mine_1_s: 2 }])).toEqual(["missed_mine"]);
  expect(columnsOf([])).toEqual([]);
});

test("numbers are rounded for reading", () => {
  expect([-1.238, 28.31, 51319.8, 3, -4, null, true].map(cellText)).toEqual([
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
  expect([0, 0.125, 0.5, 1].map(quantileText)).toEqual(["worst", "13%", "median", "best"]);
});

test("columns of numbers are recognised", () => {
  expect(areNumbers(["−2.55 (−3.23 to −1.87)", "12,345", "0.26%", "–"])).toBe(true);
  expect(areNumbers(["4.7% (3.1% to 6.8%)", "not known", "– (not needed)"])).toBe(true);
  expect(areNumbers(["1,234", "out after 27 runs"])).toBe(false);
  expect(areNumbers([])).toBe(false);
});

test("runs of scenarios without items have no columns of items", () => {
  const run = { run: "3", merit: -1, time_s: 3, found: 0, missed: 0, false_alarms: 0, served: 60 };
  expect(columnsOf([run])).toEqual(["merit", "time_s", "served"]);
  expect(columnsOf([{ ...run, found_mine: 0, missed_mine: 2 }])).toContain("found");
});
