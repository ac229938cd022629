import { expect, test } from "vitest";
import type { State } from "../api/protocol";
import { documentsOf, outcomesOf, readable } from "./differences";

const state = (outcome: Record<string, number | boolean | null>) => ({ outcome }) as unknown as State;

test("outcomes stand side by side, also columns that only one has", () => {
  const rows = outcomesOf(
    state({ run: 0, found: 2, time_s: 3, failed: true }),
    state({ run: 0, found: 4, energy_j: 1 }),
  );
  expect(rows.map(({ name, left, right }) => [name, left, right])).toEqual([
    ["found", 2, 4],
    ["time", 3, null],
    ["failed", 1, null],
    ["energy", null, 1],
  ]);
});

test("only the values in which scenarios differ are listed, with their paths", () => {
  const left = { robots: { rover: { count: 4, radius_m: 0.3 } }, clock: { step_s: 0.1 } };
  const right = {
    robots: { rover: { count: 6, radius_m: 0.3 }, cart: { count: 1 } },
    clock: { step_s: 0.1 },
  };
  expect(documentsOf(left, right)).toEqual([
    { path: "robots.rover.count", left: "4", right: "6" },
    { path: "robots.cart", left: "–", right: '{"count":1}' },
  ]);
});

test("numbers are readable", () => {
  expect([null, 12345, 0.123456, -3].map(readable)).toEqual(["–", "12,345", "0.1235", "-3"]);
});
