import { expect, test } from "vitest";
import type { WardenRobot } from "../../api/warden";
import { detailOf, faultOf, actionOf, motionOf, readable } from "./words";

const robot = (speed_m_s: number, turn_rate_rad_s: number, heading_rad: number | null = null) =>
  ({ action: "move", requested: { speed_m_s, turn_rate_rad_s, heading_rad } }) as WardenRobot;

test("a robot of which no motion is requested is not shown as moving", () => {
  expect(actionOf(robot(0, 0))).toBe("may move");
  expect(actionOf({ ...robot(0, 0), requested: null })).toBe("may move");
  for (const moving of [robot(0.4, 0), robot(0, -1), robot(0, 0, 0)]) expect(actionOf(moving)).toBe("moves");
});

test("a turn that rounds to zero has no sign", () => {
  expect(motionOf({ ...robot(0.6, -0.001), written: null })[0]).toEqual(["Requested", "0.60 m/s, turn 0°/s"]);
});

test("a standstill is confirmed with the fastest speed and turn that would go unseen, or not at all", () => {
  const standstill = (change: Partial<WardenRobot>) =>
    motionOf({ ...robot(0, 0), written: null, is_standing: true, ...change })[3]?.[1];
  const unseen = { speed_m_s: 0.2149, turn_rate_rad_s: 0.0251 };
  expect(standstill({ unseen })).toBe("confirmed (slower than 0.22 m/s and 1.44°/s)");
  expect(standstill({ unseen: { ...unseen, turn_rate_rad_s: null } })).toBe(
    "confirmed (slower than 0.22 m/s; turns are not measured)",
  );
  expect(standstill({ unseen: null })).toBe("not confirmed");
  expect(standstill({ unseen, is_standing: false })).toBe("not confirmed");
});

test("names of faults are words", () => {
  expect(["controls_deflected", "outside_world"].map(readable)).toEqual([
    "controls deflected",
    "outside world",
  ]);
});

test("a fault is named once, also if its reason begins with its name", () => {
  const fault = (name: string, reason: string) => faultOf({ name, reason });
  expect(fault("emergency_stop", "emergency stop: not released")).toBe("emergency stop: not released");
  expect(fault("emergency_stop", "emergency stop")).toBe("emergency stop");
  expect(fault("jump", "jumped by 3 m")).toBe("jump: jumped by 3 m");
  expect(detailOf({ name: "not_armed", reason: "not armed since the start" })).toBe("since the start");
});
