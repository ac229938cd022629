import { expect, test } from "vitest";
import type { WardenLink, WardenRobot } from "../../api/warden";
import { doubtsOf } from "./doubts";

const link = (port: string, age_s = 0.1): WardenLink => ({
  port,
  state: "connected",
  age_s,
  max_age_s: 1,
  reason: "",
});
const position = { port: "gps", x_m: 12, y_m: 15.04, latitude_deg: 36.595402, longitude_deg: -121.874869 };
const robot = {
  name: "bender/0",
  doubted: ["compass", "gps", "sonar"],
  faults: [{ name: "jump", reason: "compass: changed by 90.0 degrees at once" }],
  warnings: [],
  links: ["compass", "gps", "sonar"].map((port) => link(port)),
  heading: { port: "compass", magnetic_deg: 187.46, world_deg: 0, age_s: 0.1 },
  position: { ...position, uncertainty_m: 2.5, age_s: 0.1 },
  ranges: { port: "sonar", values_m: [2.24, null, null], is_known: [true, true, false], age_s: 0.1 },
} as unknown as WardenRobot;
const values = (robot: WardenRobot) => doubtsOf(robot).map(({ value }) => value.replaceAll("\u00a0", " "));

test("a doubted value is shown in the terms of the operator", () => {
  expect(values(robot)).toEqual([
    "187.5 degrees magnetic",
    "36° 35.7241′ N, 121° 52.4921′ W (12.0, 15.0 m on the map)",
    "2.2 m, no echo, unknown",
  ]);
  const far = { ...robot.position!, latitude_deg: null, longitude_deg: null, x_m: 9e6 };
  expect(values({ ...robot, position: far })[1]).toBe("(9000000.0, 15.0 m on the map)");
  const heading = { port: "compass", magnetic_deg: 359.97, world_deg: 0, age_s: 0.1 };
  expect(values({ ...robot, heading })[0]).toBe("0.0 degrees magnetic");
});

test("an old value, or none, cannot be confirmed", () => {
  expect(doubtsOf(robot).flatMap(({ reasons }) => reasons)).toEqual([]);
  const links = [link("compass", 4.2), link("sonar")];
  expect(doubtsOf({ ...robot, position: null, links }).map(({ reasons }) => reasons)).toEqual([
    ["its value is old: 4.2 s of 1.0 s"],
    ["no value is known"],
    [],
  ]);
});

test("another jump, or another robot, is something else to be confirmed", () => {
  const key = (change: Partial<WardenRobot>) => doubtsOf({ ...robot, ...change })[0]?.key;
  expect(key({ heading: null })).toBe(key({}));
  const faults = [{ name: "jump", reason: "compass: changed by 45.0 degrees at once" }];
  expect(new Set([key({}), key({ faults }), key({ name: "bender/1" })]).size).toBe(3);
});
