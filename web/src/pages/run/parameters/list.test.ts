import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import type { KindView, Table } from "../../../api/protocol";
import { changeOf, parametersOf } from "./list";
import type { Schema } from "./schema";

const schema = JSON.parse(readFileSync("../schemas/metric.schema.json", "utf8")) as Schema;

const document: Table = {
  engine: "metric",
  summary: "A search.",
  merit: { time: -0.03, energy: { weight: -1 } },
  clock: { time_limit_s: 120 },
  world: { size_m: [25, 20], obstacles: [{ circle: { at_m: [8, 16], radius_m: 1.5 } }] },
  items: { mine: { count: 4 } },
  models: { cart: { model: "ugv", price: 9000 } },
  robots: {
    rover: {
      model: "ugv",
      count: 4,
      brain: { behaviours: [{ kind: "bayesian_search" }, { kind: "avoid", near_m: 0.3 }] },
    },
  },
  study: { delta: 0.1 },
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

const all = parametersOf(schema, document, [rover]);
const at = (path: string) => all.find((parameter) => parameter.path === path);

test("numbers have bounds, help and value from schema and scenario", () => {
  expect(at("robots.rover.count")).toMatchObject({
    type: "integer",
    minimum: 0,
    maximum: 1_000_000,
    value: 4,
    help: "Number of robots of this kind in the team.",
  });
});

test("parameters that a scenario leaves out are listed with their default", () => {
  expect(at("clock.step_s")).toMatchObject({ value: undefined, fallback: 0.1 });
  expect(at("world.periodic")).toMatchObject({ type: "boolean", fallback: false });
});

test("values of a bundled robot model are listed as defaults", () => {
  expect(at("robots.rover.radius_m")?.fallback).toBe(0.27);
  expect(at("robots.rover.sensors.camera.range_m")?.fallback).toBe(3);
  expect(at("robots.rover.sensors.camera.fov_deg")?.fallback).toBe(90);
  expect(at("robots.rover.radio.range_m")?.fallback).toBe(20);
});

test("names to choose from are choices", () => {
  expect(at("robots.rover.model")).toMatchObject({
    type: "choice",
    choices: ["tracked", "ugv", "quadrotor", "cart"],
  });
  expect(at("models.cart.model")).toMatchObject({ type: "choice", value: "ugv" });
  expect(at("robots.rover.layer")).toMatchObject({ choices: ["ground", "air"], fallback: "ground" });
});

test("the values of a model of the scenario are parameters", () => {
  expect(at("models.cart.price")).toMatchObject({ type: "number", minimum: 0, value: 9000 });
  expect(at("models.cart.drive.max_speed_m_s")).toMatchObject({ value: undefined });
  expect(at("models.cart.count")).toBeUndefined();
});

test("entries of lists are listed by their kind", () => {
  expect(at("robots.rover.brain.behaviours[1].near_m")?.value).toBe(0.3);
  expect(at("robots.rover.brain.behaviours[0].value")?.help).toMatch(/^Value of searching/);
  expect(at("robots.rover.brain.behaviours[0].near_m")).toBeUndefined();
  expect(at("world.obstacles[0].circle.radius_m")?.value).toBe(1.5);
  expect(at("world.size_m[1]")?.value).toBe(20);
});

test("alternatives follow the scenario", () => {
  expect(at("merit.time")?.value).toBe(-0.03);
  expect(at("merit.energy.weight")?.value).toBe(-1);
  expect(at("merit.found")?.value).toBeUndefined();
});

test("the study and strings are not listed, and no path twice", () => {
  expect(all.filter((parameter) => /^(study|published|summary|engine)/.test(parameter.path))).toEqual([]);
  expect(new Set(all.map((parameter) => parameter.path)).size).toBe(all.length);
});

test("a value in a list is set with the whole list, which stays as it was", () => {
  const steps = ["robots", "rover", "brain", "behaviours", 1, "near_m"];
  expect(changeOf(document, steps, 0.5)).toEqual({
    path: "robots.rover.brain.behaviours",
    value: [{ kind: "bayesian_search" }, { kind: "avoid", near_m: 0.5 }],
  });
  expect(at("robots.rover.brain.behaviours[1].near_m")?.value).toBe(0.3);
});

test("a value in tables is set by its own path", () => {
  expect(changeOf(document, ["clock", "step_s"], 0.2)).toEqual({ path: "clock.step_s", value: 0.2 });
});
