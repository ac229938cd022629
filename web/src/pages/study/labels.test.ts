import { expect, test } from "vitest";
import { type Interval, RequestError, type StudyProgress } from "../../api/study";
import { ago, decimal, duration, raceFigures, places, raceSummary, errorText } from "./labels";

const bounds: Interval = [-1.66, -1.7, -1.6];
const race: StudyProgress = {
  type: "study_progress",
  state: "running",
  message: null,
  rounds: 36,
  runs: 2031,
  computed: 2031,
  seconds: 12,
  runs_per_s: 3033,
  remaining: 3,
  remaining_runs: 9000,
  remaining_s: 3.2,
  standings: [[3, 405, ...bounds]],
  eliminated: [],
  labels: null,
};
const labels = ["1 wanderer", "2 wanderers", "3 wanderers", "4 wanderers"];

test("the race is summarised in a sentence", () => {
  expect(raceSummary(race, 8, labels)).toBe(
    "Running: 3 configurations of 8 remaining, 2,031 runs, about 3 s left. Leading: 4 wanderers.",
  );
});

test("a stopped race has no speed and no time left", () => {
  const words = raceFigures({ ...race, state: "stopped" }, 8).map(([value, name]) => `${value} ${name}`);
  expect(words).toEqual(["3 of 8 remaining", "2,031 runs", "36 round", "12 s elapsed"]);
});

test("a race in another process has no known speed", () => {
  const words = raceFigures({ ...race, seconds: 0, runs_per_s: 0, remaining_s: null }, 8);
  expect(words.slice(3)).toEqual([
    ["–", "runs per second"],
    ["–", "time left (estimate)"],
  ]);
});

test("durations are rounded for reading", () => {
  expect([0.2, 42, 180, 7500].map(duration)).toEqual(["1 s", "42 s", "3 min", "2 h 5 min"]);
});

test("past times are relative to now", () => {
  const at = 1_800_000_000;
  expect([5, 70, 7300, 200_000].map((past) => ago(at - past, at))).toEqual([
    "just now",
    "1 minute ago",
    "2 hours ago",
    "2 days ago",
  ]);
});

test("merits are rounded so that delta has two significant digits", () => {
  expect([0.01, 0.05, 0.2, 3, 40].map(places)).toEqual([3, 3, 2, 1, 0]);
  expect([decimal(-1.655, 2), decimal(null, 2)]).toEqual(["−1.66", "–"]);
});

test("a request error has the server's message, and a missing server has ours", () => {
  const inputError = { file: null, line: null, path: "id", value: null, allowed: "", suggestion: null };
  expect(errorText(new RequestError([{ ...inputError, message: "id must name a study" }]))).toBe(
    "id must name a study",
  );
  expect(errorText(new TypeError("Failed to fetch"))).toBe("The server is not responding.");
});
