import { expect, test } from "vitest";
import { aside, counted, ends, turning } from "./percept";

test("rays end where they met something, and others where the sensor does", () => {
  const ring = { bearings_rad: [0, Math.PI / 2, -Math.PI / 2], range_m: 6 };
  const [ahead, left, right] = ends(ring, [2, null, 3]);
  expect(ahead).toEqual([2, 0]);
  expect(left?.[1]).toBeCloseTo(6);
  expect(right?.[1]).toBeCloseTo(-3);
});

test("messages are counted by what they are about", () => {
  const about = (kind: string) => ({ about: { [kind]: null }, confidence: 1 });
  expect(counted([about("item"), about("sender"), about("item")])).toBe("2 about items, 1 about itself");
  expect(counted([])).toBe("none");
});

test("anticlockwise is left", () => {
  expect([aside(0.5), aside(-0.5), aside(0.001)]).toEqual(["29° left", "29° right", "ahead"]);
  expect([turning(1), turning(-1), turning(0)]).toEqual([
    "57°/s to the left",
    "57°/s to the right",
    "straight",
  ]);
});
