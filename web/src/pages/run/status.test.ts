import { expect, test } from "vitest";
import type { State } from "../../api/protocol";
import { statusWords } from "./status";

const state: State = {
  type: "state",
  tick: 123,
  edge: 123,
  time_s: 12.34,
  hash: "",
  playing: true,
  speed: 3,
  real: 3.14,
  over: false,
  aim: null,
  differs_at: null,
  outcome: { found: 2 },
  mind: null,
  robot: null,
};

test("the status says in words what the picture shows", () => {
  expect(statusWords(state, [3, 1, 0, 0, 0], 4, "open")).toBe(
    "12.3 s, 4 robots: 1 in danger; 2 of 4 items found; running at 3.1 times real time.",
  );
});

test("nothing is said of items where there are none, nor of robots that are not there", () => {
  const paused = { ...state, playing: false };
  expect(statusWords(paused, [0, 0, 0, 0, 0], 0, "open")).toBe("12.3 s, 0 robots; paused.");
  expect(statusWords(paused, [1, 0, 0, 0, 0], 0, "open")).toBe("12.3 s, 1 robot: all clear; paused.");
});

test("a lost line is said before all else", () => {
  expect(statusWords(state, [4], 4, "lost")).toBe("The connection is lost.");
});
