import { expect, test } from "vitest";
import { outcomeRows } from "./outcome";

test("found is told of all, and what is weighed comes first, with units", () => {
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

test("what is not known yet is left out, and words are shown as they are", () => {
  expect(outcomeRows({ merit: null, status: "running" }, 4)).toEqual([
    { name: "status", value: "running", unit: "" },
  ]);
});

test("where an engine does not tell what was missed, all is what is target", () => {
  expect(outcomeRows({ found: 1 }, 4)[0]?.value).toBe("1 / 4");
});
