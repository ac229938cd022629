import { expect, test } from "vitest";
import type { Fault } from "../../api/protocol";
import type { Asked, Factor, Factors } from "../../api/study";
import { askOf, type Draft, draftOf, rangeWords, teamOf, wrongsOf } from "./draft";

const factor = (path: string, value: number, varied: string | null): Factor => {
  return { path, value, low: 0, high: 250, whole: true, values: null, varied };
};
const known: Factors = {
  name: "classic",
  engine: "classic",
  summary: "",
  factors: [
    factor("robots.wanderer.count", 4, "1..8"),
    factor("robots.guide.count", 1, null),
    factor("clock.time_limit_s", 120, null),
  ],
  design: "factorial",
  merits: ["equation-5.2"],
  merit: "equation-5.2",
  delta: 0.01,
  confidence: 0.95,
};
const of: Asked = { scenario: "classic", text: null };
const asked = (change: Partial<Draft>) => askOf(of, { ...draftOf(known), ...change }, known.factors);
const fault = (path: string, message: string): Fault => {
  return { file: null, line: null, path, value: null, allowed: "", suggestion: null, message };
};

test("the sizes of all teams are offered, those that the scenario varies filled in", () => {
  expect(draftOf(known).vary).toEqual({ "robots.wanderer.count": "1..8", "robots.guide.count": "" });
});

test("what the scenario asks is asked as it is, so that it is the same study", () => {
  expect(asked({})).toMatchObject({
    ask: { ...of, vary: {}, delta: null, guarantee: null, runs: null, seed: "0" },
  });
});

test("what is typed is asked, numbers as numbers", () => {
  const vary = { "robots.wanderer.count": " 2..12 ", "robots.guide.count": "" };
  expect(asked({ vary, delta: "0.05", confidence: "0.99", guarantee: "pgs", max_runs: "1e5" })).toMatchObject(
    {
      ask: {
        vary: { "robots.wanderer.count": "2..12" },
        delta: 0.05,
        confidence: 0.99,
        guarantee: "pgs",
        max_runs: 100_000,
      },
    },
  );
});

test("what is left empty is not varied, also where the scenario varies it", () => {
  const vary = { "robots.wanderer.count": "", "clock.time_limit_s": "60,120" };
  expect(asked({ vary })).toMatchObject({ ask: { vary: { "clock.time_limit_s": "60,120" } } });
  expect(asked({ vary })).not.toHaveProperty(["ask", "vary", "robots.wanderer.count"]);
});

test("a study that varies nothing is not asked", () => {
  const vary = { "robots.wanderer.count": " ", "robots.guide.count": "" };
  expect(asked({ vary })).toEqual({ wrongs: { "": expect.stringContaining("Nothing is varied") } });
});

test("what is no number is said under its field", () => {
  expect(asked({ delta: "small" })).toEqual({ wrongs: { delta: '"small" must be a number' } });
});

test("faults stand under the fields that they are about, the others apart", () => {
  const wrongs = wrongsOf(
    [
      fault('study.vary."robots.wanderer.count"', "one"),
      fault("robots.wanderer.count", "two"),
      fault("study.design", "three"),
      fault("study.vary", "four"),
      fault("folder", "five"),
    ],
    draftOf(known),
  );
  expect(wrongs).toEqual({ "robots.wanderer.count": "one two", design: "three", "": "four five" });
});

test("what may be given is said in words", () => {
  expect(rangeWords(factor("a", 1, null))).toBe("whole numbers from 0 to 250");
  expect(rangeWords({ ...factor("a", 1, null), whole: false, high: null })).toBe("numbers from 0");
  expect(rangeWords({ ...factor("a", 1, null), values: ["touch", "ahead"] })).toBe("touch, ahead");
});

test("a team is known by its path", () => {
  expect(["robots.rover.count", "items.mine.count", "robots.rover.brain.count"].map(teamOf)).toEqual([
    "rover",
    null,
    null,
  ]);
});
