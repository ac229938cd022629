import { expect, test } from "vitest";
import { type Interval, Refusal, type Studying } from "../../api/study";
import { ago, decimal, duration, figuresOf, places, raceWords, troubleOf } from "./labels";

const bounds: Interval = [-1.66, -1.7, -1.6];
const race: Studying = {
  type: "studying",
  state: "running",
  message: null,
  round: 36,
  runs: 2031,
  computed: 2031,
  seconds: 12,
  runs_per_s: 3033,
  survivors: 3,
  left_runs: 9000,
  left_s: 3.2,
  standings: [[3, 405, ...bounds]],
  eliminated: [],
  labels: null,
};
const labels = ["1 wanderer", "2 wanderers", "3 wanderers", "4 wanderers"];

test("the race is told in a sentence", () => {
  expect(raceWords(race, 8, labels)).toBe(
    "Running: 3 configurations of 8 still in, 2,031 runs, about 3 s left. In front: 4 wanderers.",
  );
});

test("a race that stands has no speed and no time left", () => {
  const words = figuresOf({ ...race, state: "stopped" }, 8).map(([value, name]) => `${value} ${name}`);
  expect(words).toEqual(["3 of 8 still in", "2,031 runs", "36 round", "12 s taken"]);
});

test("a race in another process has no known speed", () => {
  const words = figuresOf({ ...race, seconds: 0, runs_per_s: 0, left_s: null }, 8);
  expect(words.slice(3)).toEqual([
    ["–", "runs a second"],
    ["–", "left, about"],
  ]);
});

test("durations are as long as people say them", () => {
  expect([0.2, 42, 180, 7500].map(duration)).toEqual(["1 s", "42 s", "3 min", "2 h 5 min"]);
});

test("times past are told from now", () => {
  const at = 1_800_000_000;
  expect([5, 70, 7300, 200_000].map((past) => ago(at - past, at))).toEqual([
    "just now",
    "1 minute ago",
    "2 hours ago",
    "2 days ago",
  ]);
});

test("merits have so many decimals that delta has two figures", () => {
  expect([0.01, 0.05, 0.2, 3, 40].map(places)).toEqual([3, 3, 2, 1, 0]);
  expect([decimal(-1.655, 2), decimal(null, 2)]).toEqual(["−1.66", "–"]);
});

test("a refusal is told in the server's words, and a server that is gone in ours", () => {
  const fault = { file: null, line: null, path: "id", value: null, allowed: "", suggestion: null };
  expect(troubleOf(new Refusal([{ ...fault, message: "id is no study" }]))).toBe("id is no study");
  expect(troubleOf(new TypeError("Failed to fetch"))).toBe("The server does not answer.");
});
