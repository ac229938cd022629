import { beforeEach, expect, test } from "vitest";
import type { Change } from "../../api/protocol";
import { SentChanges } from "./sent_changes";

const document = { robots: { rover: { count: 4 } } };
let changes: SentChanges;

beforeEach(() => {
  changes = new SentChanges();
  changes.sent("robots.rover.count", 6);
  changes.sent("world.obstacles", [{ circle: { at_m: [1, 2], radius_m: 0.5 } }]);
});

test("a change is unconfirmed until a setting contains its value", () => {
  const log: Change[] = [
    [3, "robots.rover.count", 5],
    [3, "world.obstacles", [{ circle: { at_m: [1, 2], radius_m: 0.5 } }]],
  ];
  changes.confirm({ document, changes: [], log });
  expect(changes.takeUnconfirmed()).toEqual(["robots.rover.count"]);
  expect(changes.takeUnconfirmed()).toEqual([]);
});

test("a value that was set already is confirmed by the scenario", () => {
  changes.sent("robots.rover.count", 4);
  changes.confirm({ document, changes: [], log: null });
  expect(changes.takeUnconfirmed()).toEqual(["world.obstacles"]);
});

test("a refused change is not unconfirmed", () => {
  changes.forget("world.obstacles");
  expect(changes.takeUnconfirmed()).toEqual(["robots.rover.count"]);
  changes.sent("robots.rover.count", 6);
  changes.forget();
  expect(changes.takeUnconfirmed()).toEqual([]);
});
