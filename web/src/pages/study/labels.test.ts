import { expect, test } from "vitest";
import { RequestError, type StudyProgress } from "../../api/study";
import { errorText } from "../../shared/error_text";
import {
  ago,
  bestOf,
  decimal,
  duration,
  durations,
  highText,
  lowText,
  meritText,
  raceFigures,
  places,
  raceSummary,
} from "./labels";

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
  remaining_s: [3.2, 9],
  standings: [[3, 405, -1.66, -1.7, -1.6, null]],
  eliminated: [],
  certified: null,
  labels: null,
};
const required: StudyProgress = {
  ...race,
  remaining_s: null,
  standings: [
    [0, 40, 0.5, 0.3, 0.7, "refuted"],
    [1, 90, 0.8, 0.7, 0.9, "open"],
    [2, 90, 0.9, 0.8, 1, "certified"],
  ],
  eliminated: [[0, null, 40]],
  certified: 1,
};
const labels = ["1 wanderer", "2 wanderers", "3 wanderers", "4 wanderers"];

test("the race is summarised in a sentence", () => {
  expect(raceSummary(race, 8, labels)).toBe(
    "Running: 3 of 8 remaining, 2,031 runs, about 3 to 9 s left. Leading: 4 wanderers.",
  );
});

test("a race with a requirement is summarised by its statuses", () => {
  expect(raceSummary(required, 3, labels)).toBe(
    "Running: 1 certified, 1 eliminated, 2,031 runs. Cheapest certified: 3 wanderers.",
  );
  expect(bestOf({ ...required, standings: required.standings.slice(0, 2) })).toBe(null);
});

test("a stopped race has no speed and no time left", () => {
  const words = raceFigures({ ...race, state: "stopped" }, 8).map(([value, name]) => `${value} ${name}`);
  expect(words).toEqual(["3 of 8 remaining", "2,031 runs", "36 round", "12 s elapsed"]);
});

test("a race that has ended has no time left", () => {
  const ended: StudyProgress = { ...race, state: "answered", remaining_s: [0, 0] };
  expect(raceSummary(ended, 8, [])).not.toContain("left");
});

test("a race in another process has no known speed", () => {
  const words = raceFigures({ ...race, seconds: 0, runs_per_s: 0, remaining_s: null }, 8);
  expect(words.slice(3)).toEqual([["–", "runs per second"]]);
});

test("durations are rounded for reading", () => {
  const words = ["0 s", "1 s", "42 s", "3 min", "2 h 5 min"];
  expect([0, 0.2, 42, 180, 7500].map(duration)).toEqual(words);
});

test("a range of durations has its unit once if both ends have it", () => {
  const ranges: [number, number][] = [
    [3, 9],
    [60, 300],
    [3, 3.2],
    [120, 7500],
  ];
  expect(ranges.map(durations)).toEqual(["3 to 9 s", "60 s to 5 min", "3 s", "2 min to 2 h 5 min"]);
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
  expect([meritText(-1.655, 0.2), meritText(0.9123, null), meritText(null, null)]).toEqual([
    "−1.66",
    "91.2%",
    "–",
  ]);
});

test("a share is never rounded to none or all, and its bounds outwards only", () => {
  const shares = [0, 1, 0.0004, 1 / 20_000, 1 - 1 / 20_000].map((share) => meritText(share, null));
  expect(shares).toEqual(["0.0%", "100.0%", "0.04%", "0.005%", "99.995%"]);
  expect([lowText(0.0002, null), highText(0.0002, null)]).toEqual(["0.0%", "0.02%"]);
  expect([lowText(0.9998, null), highText(0.9998, null)]).toEqual(["99.98%", "100.0%"]);
  expect([lowText(-1.655, 0.2), highText(null, 0.2)]).toEqual(["−1.66", "–"]);
});

test("a request error has the server's message, and a missing server has ours", () => {
  const inputError = { file: null, line: null, path: "id", value: null, allowed: "", suggestion: null };
  expect(errorText(new RequestError([{ ...inputError, message: "id must name a study" }]))).toBe(
    "id must name a study",
  );
  expect(errorText(new TypeError("Failed to fetch"))).toBe("The server is not responding.");
});
