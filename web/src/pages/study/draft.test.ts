import { expect, test } from "vitest";
import type { InputError } from "../../api/protocol";
import type { Factor, Factors, ScenarioSource } from "../../api/study";
import {
  requestOf,
  type Draft,
  draftOf,
  isFoundBy,
  rangeText,
  teamOf,
  fieldErrors,
  valuesText,
} from "./draft";

const factor = (path: string, value: number, varied: string | null): Factor => {
  return { path, value, low: 0, high: 250, kind: "whole", values: null, unit: null, help: "", varied };
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
  requirement: null,
  columns: ["time_s", "collisions"],
  minimize: "robots",
  where: null,
  exported_from: null,
};
const source: ScenarioSource = { scenario: "classic", text: null };
const requested = (change: Partial<Draft>) =>
  requestOf(source, { ...draftOf(known), ...change }, known.factors);
const inputError = (path: string, message: string): InputError => {
  return { file: null, line: null, path, value: null, allowed: "", suggestion: null, message };
};

test("the counts of all robot kinds are offered, with the scenario's own ranges", () => {
  expect(draftOf(known).vary).toEqual({ "robots.wanderer.count": "1..8", "robots.guide.count": "" });
});

test("the scenario's own factors are requested unchanged, so that it is the same study", () => {
  expect(requested({})).toMatchObject({
    request: { ...source, vary: {}, delta: null, guarantee: null, runs: null, seed: "0" },
  });
});

test("entered values are requested, numbers as numbers", () => {
  const vary = { "robots.wanderer.count": " 2..12 ", "robots.guide.count": "" };
  expect(
    requested({ vary, delta: "0.05", confidence: "0.99", guarantee: "pgs", max_runs: "1e5" }),
  ).toMatchObject({
    request: {
      vary: { "robots.wanderer.count": "2..12" },
      delta: 0.05,
      confidence: 0.99,
      guarantee: "pgs",
      max_runs: 100_000,
    },
  });
});

test("empty fields are not varied, also where the scenario varies them", () => {
  const vary = { "robots.wanderer.count": "", "clock.time_limit_s": "60,120" };
  expect(requested({ vary })).toMatchObject({ request: { vary: { "clock.time_limit_s": "60,120" } } });
  expect(requested({ vary })).not.toHaveProperty(["request", "vary", "robots.wanderer.count"]);
});

test("a study without varied factors is not requested", () => {
  const vary = { "robots.wanderer.count": " ", "robots.guide.count": "" };
  expect(requested({ vary })).toEqual({ errors: { "": expect.stringContaining("No factor is varied") } });
});

test("an invalid number is an error of its field", () => {
  expect(requested({ delta: "small" })).toEqual({ errors: { delta: '"small" must be a number' } });
});

test("errors are assigned to the fields that they refer to", () => {
  const errors = fieldErrors(
    [
      inputError('study.vary."robots.wanderer.count"', "one"),
      inputError("robots.wanderer.count", "two"),
      inputError("study.design", "three"),
      inputError("study.vary", "four"),
      inputError("folder", "five"),
    ],
    draftOf(known),
  );
  expect(errors).toEqual({ "robots.wanderer.count": "one two", design: "three", "": "four five" });
});

test("allowed values are described", () => {
  expect(rangeText(factor("a", 1, null))).toBe("whole numbers from 0 to 250");
  expect(rangeText({ ...factor("a", 1, null), kind: "real", high: null })).toBe("numbers from 0");
  expect(rangeText({ ...factor("a", 1, null), values: ["touch", "ahead"] })).toBe("touch, ahead");
});

test("values have their unit", () => {
  const limit = { ...factor("clock.time_limit_s", 120, null), unit: "s" };
  expect(valuesText(limit)).toBe("Current value 120 s; whole numbers from 0 to 250 s");
  expect(valuesText({ ...limit, value: null })).toMatch(/^Current value model default; /);
  expect(valuesText(factor("robots.rover.count", 4, null))).toBe(
    "Current value 4; whole numbers from 0 to 250",
  );
});

test("a factor is found by words of its path and of its help", () => {
  const limit = { ...factor("clock.time_limit_s", 120, null), help: "A run ends at this time." };
  expect(isFoundBy(limit, ["ends", "clock"])).toBe(true);
  expect(isFoundBy(limit, ["ends", "radio"])).toBe(false);
});

test("kinds of robots and controllers are recognised by their paths", () => {
  const paths = [
    "robots.rover.count",
    "controllers.base.count",
    "items.mine.count",
    "robots.rover.brain.count",
  ];
  expect(paths.map(teamOf)).toEqual(["rover", "base", null, null]);
});

test("each question is requested with its own parts only", () => {
  const filled = {
    delta: "0.05",
    merit: "m",
    require: " time_s <= 60 \n\ncollisions <= 0",
    probability: "0.9",
    minimize: "price",
  };
  expect(requested({ ...filled, question: "requirement" })).toMatchObject({
    request: {
      question: "requirement",
      require: ["time_s <= 60", "collisions <= 0"],
      probability: 0.9,
      tolerance: null,
      minimize: "price",
      delta: null,
      guarantee: null,
      merit: null,
    },
  });
  expect(requested({ ...filled, question: "merit" })).toMatchObject({
    request: { question: "merit", require: null, probability: null, minimize: null, delta: 0.05, merit: "m" },
  });
});

test("the question is that of the scenario, and errors of conditions are beside them", () => {
  const requirement = { words: "", conditions: ["time_s <= 60"], probability: 0.9, tolerance: 0.02 };
  const draft = draftOf({ ...known, requirement });
  expect(draft.question).toBe("requirement");
  const paths = ["require.all[1]", "require.probability", "study.minimize"];
  const errors = fieldErrors(
    paths.map((path) => inputError(path, path)),
    draft,
  );
  expect(errors).toEqual({
    require: "require.all[1]",
    probability: "require.probability",
    minimize: "study.minimize",
  });
});
