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
  expect(outcomeRows({ energy_j: null }, 4)).toEqual([{ name: "energy", value: "not counted", unit: "" }]);
});

test("unknown values are left out, and text is unchanged", () => {
  expect(outcomeRows({ merit: null, status: "running" }, 4)).toEqual([
    { name: "status", value: "running", unit: "" },
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
