import { expect, test } from "vitest";
import type { ControllerView, GoalStatus, GoalView, Setting } from "../api/protocol";
import { colourOf, controllerAt, countsOf, goalsOf, hasEconomy, ownerColours, reasonLabel } from "./economy";

const goal = (status: GoalStatus, owner: string | null = null): GoalView => ({
  name: "spot/0",
  at: [0, 0],
  status,
  owner,
  heir: null,
  robot: null,
  lease_s: null,
  unserved: null,
});
const controllers = Array.from({ length: 8 }, (_, i) => ({ name: `base/${i}` }) as ControllerView);
const documentOf = (document: object) => ({ document }) as Setting;

test("a run has an economy if its scenario has goals or controllers", () => {
  expect(hasEconomy(documentOf({ goals: { spot: {} } }))).toBe(true);
  expect(hasEconomy(documentOf({ controllers: { base: {} } }))).toBe(true);
  expect(hasEconomy(documentOf({ goals: {}, robots: { rover: {} } }))).toBe(false);
});

test("each controller has a colour of its own until the colours repeat", () => {
  const colours = controllers.map(({ name }) => colourOf(controllers, name));
  expect(new Set(colours.slice(0, ownerColours)).size).toBe(ownerColours);
  expect(colours[ownerColours]).toBe(colours[0]);
  expect(colourOf(controllers, "base/9")).toBeNull();
  expect(colourOf(controllers, null)).toBeNull();
});

test("goals are counted by status, and only those that occur", () => {
  expect(countsOf([goal("served"), goal("open"), goal("open")])).toBe("2 open, 1 served");
  expect(countsOf([])).toBe("no goals");
});

test("the goals of a controller are those that it owns", () => {
  const goals = [goal("open", "base/0"), goal("awarded", "base/1"), goal("served")];
  expect(goalsOf(goals, "base/1")).toEqual([goals[1]]);
  expect(goalsOf(goals, null)).toEqual(goals);
});

test("a reason without a label is displayed as it is", () => {
  expect(reasonLabel("no_robot")).toBe("no robot is in range");
  expect(reasonLabel("no_controller")).toBe("no controller works");
  expect(reasonLabel("other")).toBe("other");
});

test("the nearest controller in reach is at a place, unless a robot carries it", () => {
  const at = (name: string, x: number, aboard: string | null = null) =>
    ({ name, at: [x, 0], aboard }) as ControllerView;
  const some = [at("base/0", 0), at("base/1", 5), at("car/0", 9, "rover/2")];
  expect(controllerAt(some, [3, 0], 4)).toBe("base/1");
  expect(controllerAt(some, [3, 0], 1)).toBeNull();
  expect(controllerAt(some, [9, 0], 1)).toBeNull();
});
