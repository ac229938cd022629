import { expect, test } from "vitest";
import type { SeriesAnswer, State } from "../../api/protocol";
import { Series } from "./series";

function state(tick: number, found: number, latest_tick = tick): State {
  const outcome = { found, status: "running" };
  return {
    type: "state",
    tick,
    latest_tick,
    time_s: tick / 10,
    hash: "",
    is_playing: true,
    speed: 1,
    measured_speed: 1,
    is_over: false,
    target_tick: null,
    mismatch_tick: null,
    outcome,
    inspection: null,
    robot: null,
  };
}

function answer(since: number, ...found: [tick: number, found: number][]): SeriesAnswer {
  const rows = found.map(([tick, value]) => ({ tick, values: [value, null] }));
  return { type: "series", since, columns: ["found", "energy_j"], rows };
}

function series(...found: [number, number][]): Series {
  const series = new Series();
  series.renew(0.1);
  series.add(answer(0, ...found));
  return series;
}

const ticks = (series: Series) => series.rows.map((row) => row.tick);

test("rows of the server replace all rows from their first tick on", () => {
  const run = series([0, 0], [10, 1], [20, 2]);
  expect(run.since).toBe(20);
  expect(run.add(answer(20, [20, 2], [25, 3]))).toBe(true);
  expect(ticks(run)).toEqual([0, 10, 20, 25]);
});

test("the present is the last row, unless the run was moved back", () => {
  const run = series([0, 0], [10, 1]);
  run.setPresent(state(12, 1));
  expect(ticks(run)).toEqual([0, 10, 12]);
  run.setPresent(state(14, 1));
  expect(ticks(run)).toEqual([0, 10, 14]);
  run.setPresent(state(5, 0, 14));
  expect(ticks(run)).toEqual([0, 10]);
});

test("rows of a discarded future are removed", () => {
  const run = series([0, 0], [10, 1], [20, 2], [30, 2]);
  run.setPresent(state(12, 1, 12));
  expect(ticks(run)).toEqual([0, 10, 12]);
});

test("after a change all rows are requested, and an answer to an earlier request is not used", () => {
  const run = series([0, 0], [10, 1]);
  run.renew(0.1);
  expect(run.since).toBe(0);
  expect(run.add(answer(10, [10, 1], [20, 5]))).toBe(false);
  expect(run.add(answer(0, [0, 0], [15, 4]))).toBe(true);
  expect(ticks(run)).toEqual([0, 15]);
});

test("a CSV has a column for each number, and none for text", () => {
  const run = series([0, 0]);
  run.setPresent(state(10, 3));
  expect(run.csv()).toBe("tick,time_s,found\n0,0,0\n10,1,3\n");
});

test("a changed step length applies to all rows", () => {
  const run = series([0, 0], [10, 3]);
  run.renew(0.5);
  expect(run.rows.map((row) => row.time_s)).toEqual([0, 5]);
});
