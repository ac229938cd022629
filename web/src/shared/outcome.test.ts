import { expect, test } from "vitest";
import { outcomeRows, withoutFindTimes } from "./outcome";

test("found is given out of all, and the terms of the merit come first, with units", () => {
  const rows = outcomeRows(
    {
      run: 7,
      time_s: 12.3456,
      energy_j: 48_512,
      found: 1,
      missed: 3,
      merit: -1.234,
      collisions: 0,
    },
    9,
  );
  expect(rows.map(({ name, value, unit }) => `${name} ${value} ${unit}`.trim())).toEqual([
    "found 1 / 4",
    "merit -1.23",
    "collisions 0",
    "energy 48.51 kJ",
    "time 12.35 s",
  ]);
});

test("energy without a battery is not counted, rather than nothing", () => {
  expect(outcomeRows({ energy_j: null }, 4)).toEqual([
    { column: "energy_j", name: "energy", value: "not counted", unit: "" },
  ]);
});

test("unknown values are left out, and text is unchanged", () => {
  expect(outcomeRows({ merit: null, status: "running" }, 4)).toEqual([
    { column: "status", name: "status", value: "running", unit: "" },
  ]);
});

test("without a count of missed items, all targets are counted", () => {
  expect(outcomeRows({ found: 1 }, 4)[0]?.value).toBe("1 / 4");
});

test("the times of finds are left out, and counts of kinds with similar names are not", () => {
  const outcome = { found_mine: 1, missed_mine: 1, found_mine_1_s: 2.5, found_mine_2_s: null };
  expect(outcomeRows(outcome, 2).map(({ name }) => name)).toEqual(["found mine", "missed mine"]);
  const columns = ["found_cow_1_s", "missed_cow_1_s", "found_cow_1_s_1_s", "time_s"];
  expect(withoutFindTimes(columns)).toEqual(["found_cow_1_s", "missed_cow_1_s", "time_s"]);
});

test("a flag and the time at which it was set are one row", () => {
  const rows = (outcome: Parameters<typeof outcomeRows>[0]) =>
    outcomeRows(outcome, 0).map(({ name, value, unit }) => `${name} ${value} ${unit}`.trim());
  const times = { declared_s: 352, given_up_s: 600, time_s: 352 };
  expect(rows({ declared: true, given_up: false, ...times })).toEqual([
    "declared 352 s",
    "given up no",
    "time 352 s",
  ]);
  expect(rows({ declared: 0, given_up: 1, ...times })).toEqual([
    "declared no",
    "given up 600 s",
    "time 352 s",
  ]);
});

test("only the reason for which a run is over is a row", () => {
  const outcome = { ended_hopeless: true, ended_time_limit: false };
  expect(outcomeRows(outcome, 0)).toEqual([
    { column: "ended_hopeless", name: "ended", value: "hopeless", unit: "" },
  ]);
  expect(outcomeRows({ ended_hopeless: 0, ended_time_limit: 0 }, 0)).toEqual([]);
});
