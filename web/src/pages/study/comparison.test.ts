import { expect, test } from "vitest";
import type { StudyResult } from "../../api/study";
import { evidenceOf, factsOf, resultsOf } from "./comparison";

const result = (label: string, more: Partial<StudyResult> = {}): StudyResult => ({
  configuration: 0,
  label,
  runs: 1,
  verdict: "best",
  eliminated: false,
  met: null,
  ...more,
});

test("configurations with the same label stand side by side, and others alone", () => {
  const rows = resultsOf([result("3 rovers"), result("4 rovers")], [result("4 rovers"), result("5 rovers")]);
  expect(rows.map(({ label, a, b }) => [label, a !== null, b !== null])).toEqual([
    ["3 rovers", true, false],
    ["4 rovers", true, true],
    ["5 rovers", false, true],
  ]);
});

test("the evidence of a configuration is its verdict, its runs and its share", () => {
  expect(evidenceOf(null)).toBe("not compared");
  expect(evidenceOf(result("a"))).toBe("best, 1 run");
  expect(evidenceOf(result("a", { runs: 1200, verdict: "certified", met: [0.975, 0.951, 0.99] }))).toBe(
    "certified, 1,200 runs, 97.5% (95.1 to 99.0%)",
  );
});

test("facts that only one answer has are missing in the other", () => {
  expect(
    factsOf(
      [["Runs", "10"]],
      [
        ["Runs", "20"],
        ["Seed", "7"],
      ],
    ),
  ).toEqual([
    ["Runs", "10", "20"],
    ["Seed", "–", "7"],
  ]);
});
