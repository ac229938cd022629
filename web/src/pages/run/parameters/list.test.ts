import { expect, test } from "vitest";
import type { KindView, Parameter, PathStep, Table } from "../../../api/protocol";
import { changeOf, parametersOf, valueAt } from "./list";

const document: Table = {
  robots: { rover: { brain: { behaviours: [{ kind: "bayesian_search" }, { kind: "avoid", near_m: 0.3 }] } } },
};

const rover: KindView = {
  name: "rover",
  count: 4,
  radius: 0.27,
  rings: [],
  is_flying: false,
  radio_range_m: 20,
  sensors: [{ name: "camera", kind: "items", range_m: 3, width_rad: Math.PI / 2, facing_rad: 0 }],
};

function described(...steps: PathStep[]): Parameter {
  return {
    steps,
    value: null,
    default: 1,
    low: 0,
    high: null,
    kind: "real",
    values: null,
    unit: null,
    help: "",
  };
}

const parameters = [
  described("robots", "rover", "brain", "behaviours", 1, "near_m"),
  described("robots", "rover", "layer"),
  described("robots", "rover", "sensors", "camera", "fov_deg"),
];
const all = parametersOf({ parameters, kinds: [rover] });

test("parameters have a path as error messages write it, and bounds", () => {
  expect(all[0]).toMatchObject({
    path: "robots.rover.brain.behaviours[1].near_m",
    minimum: 0,
    maximum: Number.POSITIVE_INFINITY,
    fallback: 1,
  });
});

test("values of a robot that the scenario leaves out are listed as defaults", () => {
  expect(all.map(({ fallback }) => fallback)).toEqual([1, "ground", 90]);
});

test("a value in a list is set with the whole list, which stays as it was", () => {
  const steps = ["robots", "rover", "brain", "behaviours", 1, "near_m"];
  expect(changeOf(document, steps, 0.5)).toEqual({
    path: "robots.rover.brain.behaviours",
    value: [{ kind: "bayesian_search" }, { kind: "avoid", near_m: 0.5 }],
  });
  expect(valueAt(document, steps)).toBe(0.3);
});

test("a value in tables is set by its own path", () => {
  expect(changeOf(document, ["clock", "step_s"], 0.2)).toEqual({ path: "clock.step_s", value: 0.2 });
});
