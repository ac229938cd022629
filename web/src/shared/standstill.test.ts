import { expect, test } from "vitest";
import { roundedUp, standstills } from "./standstill";

const robot = (number: number, speed_m_s?: number) => ({
  name: `bender/${number}`,
  unseen: speed_m_s === undefined ? null : { speed_m_s },
});

test("an upper limit is rounded up, never down, and not because of rounding errors", () => {
  expect([0.2101, 0.22, 0.07, 0.29, 1, 0].map(roundedUp)).toEqual([
    "0.22",
    "0.22",
    "0.07",
    "0.29",
    "1.00",
    "0.00",
  ]);
});

test("a confirmed standstill has a number: the fastest motion of any of the robots that would go unseen", () => {
  expect(standstills([robot(0, 0.211)])).toBe("bender/0: standstill confirmed (slower than 0.22 m/s)");
  expect(standstills([robot(0, 0.211), robot(1, 0.31)])).toBe(
    "all 2 robots: standstill confirmed (slower than 0.31 m/s)",
  );
});

test("robots whose standstill is not confirmed come first, by name", () => {
  expect(standstills([robot(0, 0.2), robot(1), robot(2, 0.3), robot(3)])).toBe(
    "bender/1, bender/3: standstill not confirmed · 2 others: standstill confirmed (slower than 0.30 m/s)",
  );
});
