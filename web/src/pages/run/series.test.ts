import { expect, test } from "vitest";
import type { State } from "../../api/protocol";
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

const ticks = (series: Series) => series.rows.map((row) => row.tick);

test("rows are ordered by tick, in whichever order they arrive", () => {
  const series = new Series();
  for (const tick of [0, 10, 20, 5, 15]) series.add(state(tick, 0, 20));
  expect(ticks(series)).toEqual([0, 5, 10, 15, 20]);
});

test("a repeated tick replaces its row", () => {
  const series = new Series();
  series.add(state(10, 1));
  series.add(state(10, 2));
  expect(series.rows.map((row) => row.values.found)).toEqual([2]);
});

test("rows of a discarded future are removed", () => {
  const series = new Series();
  for (const tick of [0, 10, 20, 30]) series.add(state(tick, 0));
  series.add(state(12, 0, 12));
  expect(ticks(series)).toEqual([0, 10, 12]);
});

test("a CSV has a column for each number, and none for text", () => {
  const series = new Series();
  series.add(state(0, 0));
  series.add(state(10, 3));
  expect(series.csv()).toBe("tick,time_s,found\n0,0,0\n10,1,3\n");
});

test("a changed step length applies to all rows", () => {
  const series = new Series();
  series.add(state(0, 0));
  series.add(state(10, 3));
  series.setStep(0.5);
  expect(series.rows.map((row) => row.time_s)).toEqual([0, 5]);
});
