import { expect, test } from "vitest";
import { documentsOf, readable } from "./differences";

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
