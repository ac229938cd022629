import { expect, test } from "vitest";
import { csv } from "./csv";
import { labelsOf, linesOf, pointsOf, valueAt } from "./lines";
import { noSamples, withSamples } from "./samples";
import { available, described, inspected, paths } from "./signals";

const answer = (since: number, rows: [number, number | null][], signals = ["body/rover/0/x_m"]) => ({
  type: "signals" as const,
  signals,
  since,
  until: rows.at(-1)?.[0] ?? 0,
  every: 1,
  rows: rows.map(([tick, value]) => ({ tick, values: [value] })),
});
const offer = {
  layers: [],
  panels: [],
  events: [],
  signals: [{ id: "controller/base/0/goals", label: "goals owned", unit: "", of: "base/0" }],
  robot_signals: [{ id: "body/{robot}/x_m", label: "x", unit: "m", of: "" }],
  columns: [],
};

test("samples replace those from their first tick on, and all if the signals differ", () => {
  const first = withSamples(
    noSamples,
    answer(0, [
      [0, 1],
      [1, 2],
    ]),
  );
  expect(
    withSamples(
      first,
      answer(1, [
        [1, 5],
        [2, 6],
      ]),
    ).rows.map(({ values }) => values[0]),
  ).toEqual([1, 5, 6]);
  expect(withSamples(first, answer(2, [[2, 9]], ["other"])).rows).toHaveLength(1);
});

test("the first unit has the left axis, others the right one, unless it is chosen", () => {
  const signal = (id: string, unit: string) => ({ id, unit, label: id, of: "" });
  const lines = linesOf([signal("x", "m"), signal("y", "m"), signal("v", "m/s")], { y: "right" });
  expect(lines.map(({ axis }) => axis)).toEqual(["left", "right", "right"]);
});

test("the CSV has exactly the points of the lines, and empty cells where a line has none", () => {
  const one = { id: "outcome/found", points: { ticks: [0, 30], values: [0, 1] } };
  const two = { id: 'a"b', points: { ticks: [0, 10], values: [null, 0.1 + 0.2] } };
  expect(csv([one, two], 0.1)).toBe(
    'tick,time_s,outcome/found,"a""b"\n0,0,0,\n10,1,,0.30000000000000004\n30,3,1,\n',
  );
});

test("the value of a line is its last one up to a tick", () => {
  const points = { ticks: [0, 10], values: [3, null] };
  expect([-1, 0, 9, 10].map((tick) => valueAt(points, tick))).toEqual([null, 3, 3, null]);
});

test("numbers of the outcome come from its series, all others from samples", () => {
  const series = [{ tick: 4, time_s: 0.4, values: { found: 2 } }];
  const samples = withSamples(noSamples, answer(0, [[0, 7]]));
  expect(pointsOf("outcome/found", series, samples)).toEqual({ ticks: [4], values: [2] });
  expect(pointsOf("body/rover/0/x_m", series, samples)).toEqual({ ticks: [0], values: [7] });
  expect(pointsOf("body/rover/1/x_m", series, samples)).toEqual({ ticks: [], values: [] });
});

test("every number in an inspection has a path, a label and a unit", () => {
  const percept = { position: { value: [1, 2], age_s: 0 }, touch: null, motion: { value: { speed_m_s: 1 } } };
  expect(paths({ percept })).toEqual([
    "percept/position/value/0",
    "percept/position/value/1",
    "percept/position/age_s",
    "percept/motion/value/speed_m_s",
  ]);
  expect(inspected("rover/0", "percept/motion/value/speed_m_s")).toEqual({
    id: "robot/rover/0/percept/motion/value/speed_m_s",
    label: "percept motion speed",
    unit: "m/s",
    of: "rover/0",
  });
});

test("what can be drawn is the outcome, the robot that is selected, and the controllers", () => {
  const state = { outcome: { found: 1, time_s: 3, run: 0, complete: false }, inspection: null };
  const ids = (robot: string | null) => available(offer, state as never, robot).map(({ id }) => id);
  expect(ids(null)).toEqual(["outcome/found", "outcome/time_s", "controller/base/0/goals"]);
  expect(ids("rover/3")).toContain("body/rover/3/x_m");
  expect(described("body/rover/3/x_m", offer)).toMatchObject({ label: "x", unit: "m", of: "rover/3" });
  expect(described("outcome/energy_j", offer)).toMatchObject({ label: "energy", unit: "J" });
});

test("marks of an axis that are near each other have different labels", () => {
  expect(labelsOf([0.9999, 0.99995, 1], 5e-5)).toEqual(["0.9999", "0.99995", "1"]);
  expect(labelsOf([0, 0.25, 0.5], 0.25)).toEqual(["0", "0.25", "0.5"]);
  expect(labelsOf([0, 20_000], 20_000)).toEqual(["0", "20,000"]);
});
