import { expect, test } from "vitest";
import type { RobotMessage } from "../../api/protocol";
import { bearingText, messageCounts, rayEnds, turnText } from "./percept";

test("rays end at their reading, or at the sensor's range", () => {
  const ring = { bearings_rad: [0, Math.PI / 2, -Math.PI / 2], range_m: 6 };
  const [ahead, left, right] = rayEnds(ring, [2, null, 3]);
  expect(ahead).toEqual([2, 0]);
  expect(left?.[1]).toBeCloseTo(6);
  expect(right?.[1]).toBeCloseTo(-3);
});

test("messages are counted by subject", () => {
  const about = (kind: string) => ({ about: { [kind]: null }, confidence: 1 }) as unknown as RobotMessage;
  expect(messageCounts([about("item"), about("sender"), about("item")])).toBe(
    "2 about items, 1 about the sender",
  );
  expect(messageCounts([about("contract")])).toBe("1 about goals of controllers");
  expect(messageCounts([])).toBe("none");
});

test("anticlockwise is left", () => {
  expect([bearingText(0.5), bearingText(-0.5), bearingText(0.001)]).toEqual([
    "29° left",
    "29° right",
    "ahead",
  ]);
  expect([turnText(1), turnText(-1), turnText(0)]).toEqual(["57°/s left", "57°/s right", "straight"]);
});
