import { expect, test } from "vitest";
import { type Behaviour, behavioursOf, isOn, type Switch, switched, switches, usesGoals } from "./behaviours";

const named = (name: string) => switches.find((one) => one.name === name) as Switch;
const kinds = (list: { kind: string }[]) => list.map((one) => one.kind);
const seekers: Behaviour[] = [
  { kind: "bayesian_search", value: 2 },
  { kind: "return_home" },
  { kind: "avoid" },
];

test("a robot kind without behaviours searches by random bounce", () => {
  const behaviours = behavioursOf({ robots: { rover: { count: 1 } } }, "rover");
  expect(kinds(behaviours)).toEqual(["cruise", "random_bounce", "avoid"]);
  expect(isOn(behaviours, named("Search"))).toBe(true);
  expect(isOn(behaviours, named("Flock"))).toBe(false);
});

test("a robot kind has the behaviours of its model, unless it lists others", () => {
  const brain = { behaviours: [{ kind: "frontier" }], arbitration: { kind: "goals" } };
  const models = { cart: { model: "base" }, base: { model: "cart", brain } };
  const robots = { a: { model: "cart" }, b: { model: "cart", brain: { behaviours: [{ kind: "avoid" }] } } };
  const document = { models, robots };
  expect(kinds(behavioursOf(document, "a"))).toEqual(["frontier"]);
  expect(kinds(behavioursOf(document, "b"))).toEqual(["avoid"]);
  expect(usesGoals(document, "b")).toBe(true);
  expect(usesGoals({ models, robots: { c: { model: "ugv" } } }, "c")).toBe(false);
});

test("switching off and on again gives the behaviour back with its values, below the reflexes", () => {
  const off = switched(seekers, named("Search"), [], true);
  expect(kinds(off)).toEqual(["return_home", "avoid"]);
  expect(switched(off, named("Search"), [{ kind: "bayesian_search", value: 2 }], true)).toEqual(seekers);
});

test("a switch adds a behaviour that the brain supports", () => {
  const off = [{ kind: "avoid" }];
  expect(kinds(switched(off, named("Search"), [], true))).toEqual(["bayesian_search", "avoid"]);
  expect(kinds(switched(off, named("Search"), [], false))).toEqual(["random_bounce", "avoid"]);
  expect(kinds(switched(off, named("Flock"), [], false))).toEqual(["flock", "avoid"]);
});

test("brains that select goals are known by their arbitration", () => {
  const brain = { arbitration: { kind: "goals" } };
  expect(usesGoals({ robots: { rover: { brain } } }, "rover")).toBe(true);
  expect(usesGoals({ robots: { rover: {} } }, "rover")).toBe(false);
});
