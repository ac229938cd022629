import { expect, test } from "vitest";
import type { Frame } from "../api/frames";
import type { Setting } from "../api/protocol";
import { Interpolation, motionLimitOf } from "./interpolation";

const limit = { speed: 2, distance: 50 };

function frame(tick: number, robots: number[][], generation = 1): Frame {
  return {
    generation,
    tick,
    time_s: tick / 10,
    number: tick,
    count: robots.length,
    robots: new Float32Array(robots.flat()),
    items: new Uint8Array(),
  };
}

/** Two frames received a tenth of a second apart, the second at 1100 ms. */
function moving(from: number[][], to: number[][], generation = 1): Interpolation {
  const motion = new Interpolation();
  motion.put(frame(5, from), 1000, limit);
  motion.at(1000, true);
  motion.put(frame(6, to, generation), 1100, limit);
  return motion;
}

const poses = (motion: Interpolation, now_ms: number, moves = true) =>
  Array.from(motion.at(now_ms, moves)?.robots ?? []).map((value) => Number(value.toFixed(3)));

test("between two frames poses and time are interpolated", () => {
  const motion = moving([[1, 2, 0.5, 0]], [[1.1, 1.9, 0.7, 1]]);
  expect(poses(motion, 1100)).toEqual([1, 2, 0.5, 1]);
  expect(poses(motion, 1150)).toEqual([1.05, 1.95, 0.6, 1]);
  expect(motion.at(1150, true)?.time_s).toBeCloseTo(0.55);
  expect(motion.isMoving).toBe(true);
});

test("the overlay of moving robots is that of the previous frame", () => {
  const over = (tick: number, robots: number[][]): Frame => {
    const base = frame(tick, robots);
    const footprints = { frame: tick, links: new Uint32Array(), footprints: [], robots: base.robots };
    return { ...base, overlay: footprints };
  };
  const motion = new Interpolation();
  motion.put(over(5, [[1, 2, 0.5, 0]]), 1000, limit);
  motion.at(1000, true);
  motion.put(over(6, [[1.1, 1.9, 0.7, 1]]), 1100, limit);
  expect(motion.at(1150, true)?.overlay?.frame).toBe(5);
  expect(Array.from(motion.at(1150, true)?.overlay?.robots ?? []).slice(0, 2)).toEqual([1, 2]);
  expect(motion.at(1200, true)?.overlay?.frame).toBe(6);
});

test("poses are not extrapolated, however late the next frame is", () => {
  const motion = moving([[1, 2, 0, 0]], [[1.1, 2, 0, 0]]);
  for (const now_ms of [1200, 1300, 9000]) expect(poses(motion, now_ms)).toEqual([1.1, 2, 0, 0]);
  expect(motion.isMoving).toBe(false);
});

test("after an early frame, motion continues from the drawn poses", () => {
  const motion = moving([[1, 2, 0, 0]], [[1.1, 2, 0, 0]]);
  poses(motion, 1150);
  motion.put(frame(7, [[1.2, 2, 0, 0]]), 1150, limit);
  expect(poses(motion, 1150)).toEqual([1.05, 2, 0, 0]);
  expect(poses(motion, 1175)).toEqual([1.125, 2, 0, 0]);
});

test("a heading takes the shortest rotation", () => {
  const motion = moving([[1, 2, 3.1, 0]], [[1, 2, -3.1, 0]]);
  expect(Math.abs(poses(motion, 1150)[2] ?? 0)).toBeCloseTo(Math.PI, 2);
});

test("a robot that jumped is moved at once, and others are interpolated", () => {
  const there = [99.9, 2, 1, 0];
  const motion = moving(
    [
      [0.1, 2, 0, 0],
      [1, 2, 0, 0],
    ],
    [there, [1.1, 2, 0, 0]],
  );
  expect(poses(motion, 1150)).toEqual([...there, 1.05, 2, 0, 0]);
});

test("while paused, and with reduced motion, the latest frame is drawn", () => {
  const motion = moving([[1, 2, 0, 0]], [[1.1, 2, 0, 0]]);
  expect(poses(motion, 1150, false)).toEqual([1.1, 2, 0, 0]);
  expect(motion.isMoving).toBe(false);
});

test.each([
  ["of another setting", [[2, 2, 0, 0]], 2, 1100],
  [
    "with another robot",
    [
      [1.1, 2, 0, 0],
      [3, 3, 0, 0],
    ],
    1,
    1100,
  ],
])("a frame %s is drawn as received", (_, to, generation, now_ms) => {
  expect(poses(moving([[1, 2, 0, 0]], to, generation), now_ms)).toEqual(to.flat());
});

test.each([
  ["back in time", 4, 1100],
  ["soon after the last", 6, 1030],
  ["after a pause", 6, 9000],
])("a frame %s is drawn as received", (_, tick, now_ms) => {
  const motion = new Interpolation();
  motion.put(frame(5, [[1, 2, 0, 0]]), 1000, limit);
  motion.at(1000, true);
  motion.put(frame(tick, [[1.1, 2, 0, 0]]), now_ms, limit);
  expect(poses(motion, now_ms)).toEqual([1.1, 2, 0, 0]);
});

test("the limit is the speed of the fastest kind, and half of the world", () => {
  const robots = { slow: { drive: { max_speed_m_s: 1 } }, fast: { drive: { max_speed_m_s: 5 } } };
  const setting = { world: { size: [40, 30] }, document: { robots } } as unknown as Setting;
  expect(motionLimitOf(setting)).toEqual({ speed: 5, distance: 15 });
});
