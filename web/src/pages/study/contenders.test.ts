import { expect, test } from "vitest";
import type { RequirementStatus, Standing } from "../../api/study";
import { contenders } from "./contenders";
import { domainFor } from "./domain";

const ranged = (configuration: number, low: number, high: number): Standing => {
  return [configuration, 40, (low + high) / 2, low, high, null];
};
const shared = (configuration: number, share: number, status: RequirementStatus): Standing => {
  return [configuration, 40, share, share - 0.02, Math.min(1, share + 0.02), status];
};
const namesOf = (standings: Standing[]) => standings.map(([configuration]) => configuration);

const byMerit = [ranged(4, -1.5, -1.3), ranged(5, -1.6, -1.4), ranged(9, -1.9, -1.7), ranged(0, -30, -28)];
const byCost = [
  shared(0, 0.03, "refuted"),
  shared(1, 0.4, "refuted"),
  shared(2, 0.85, "refuted"),
  shared(3, 0.9, "refuted"),
  shared(4, 0.97, "certified"),
  shared(5, 0.96, "open"),
  shared(6, 0.5, "not needed"),
];

test("a configuration far behind does not squeeze the axis of the contenders", () => {
  const [low, high] = domainFor(null, contenders(byMerit, 4)) ?? [NaN, NaN];
  expect(low).toBeGreaterThan(-2);
  expect(high).toBeLessThan(-1);
});

test("the axis of all configurations contains the one far behind", () => {
  const [low] = domainFor(null, byMerit) ?? [NaN];
  expect(low).toBeLessThanOrEqual(-30);
});

test("contenders by merit are those whose range reaches that of the best, and at least two", () => {
  expect(namesOf(contenders(byMerit, 4))).toEqual([4, 5]);
  expect(namesOf(contenders([ranged(1, 0, 1), ranged(2, -9, -8), ranged(3, -9, -8)], 1))).toEqual([1, 2]);
});

test("contenders of a requirement are certified, open, or the next cheaper one", () => {
  expect(namesOf(contenders(byCost, 4))).toEqual([3, 4, 5]);
});

test("if none is certified, the dearest is a contender", () => {
  expect(namesOf(contenders(byCost.slice(0, 4), null))).toEqual([3]);
});

test("without ranges, all are contenders", () => {
  const bare: Standing[] = [
    [1, 8, 0.5, null, null, null],
    [2, 8, -3, null, null, null],
  ];
  expect(contenders(bare, 1)).toEqual(bare);
});
