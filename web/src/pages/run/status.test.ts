import { expect, test } from "vitest";
import type { State } from "../../api/protocol";
import { statusText } from "./status";

const state: State = {
  type: "state",
  tick: 123,
  latest_tick: 123,
  time_s: 12.34,
  hash: "",
  is_playing: true,
  speed: 3,
  measured_speed: 3.14,
  is_over: false,
  target_tick: null,
  mismatch_tick: null,
  outcome: { found: 2 },
  inspection: null,
  robot: null,
};

test("the status summarises the run in one sentence", () => {
  expect(statusText(state, [3, 1, 0, 0, 0], 4, "open")).toBe(
    "12.3 s, 4 robots: 1 about to collide; 2 of 4 items found; running at 3.1 × real time.",
  );
});

test("items and robot states are left out where there are none", () => {
  const paused = { ...state, is_playing: false };
  expect(statusText(paused, [0, 0, 0, 0, 0], 0, "open")).toBe("12.3 s, 0 robots; paused.");
  expect(statusText(paused, [1, 0, 0, 0, 0], 0, "open")).toBe("12.3 s, 1 robot: all clear; paused.");
});

test("a run of a comparison, which the clock of both moves, is neither paused nor running", () => {
  const paused = { ...state, is_playing: false };
  expect(statusText(paused, [1, 0, 0, 0, 0], 0, "open", false)).toBe("12.3 s, 1 robot: all clear.");
  const finished = { ...paused, is_over: true };
  expect(statusText(finished, [1, 0, 0, 0, 0], 0, "open", false)).toBe(
    "12.3 s, 1 robot: all clear; finished.",
  );
});

test("a lost connection takes precedence", () => {
  expect(statusText(state, [4], 4, "lost")).toBe("The connection is lost.");
});
