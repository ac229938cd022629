import { expect, test } from "vitest";
import type { Frame } from "../api/frames";
import type { Setting } from "../api/protocol";
import { Motion, reachOf } from "./interpolation";

const reach = { speed: 2, most: 50 };

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

/** Two frames that came a tenth of a second apart, the second at 1100 ms. */
function moving(from: number[][], to: number[][], generation = 1): Motion {
  const motion = new Motion();
  motion.put(frame(5, from), 1000, reach);
  motion.at(1000, true);
  motion.put(frame(6, to, generation), 1100, reach);
  return motion;
}

const poses = (motion: Motion, now_ms: number, moves = true) =>
  Array.from(motion.at(now_ms, moves)?.robots ?? []).map((value) => Number(value.toFixed(3)));

test("between two frames robots are drawn on their way, at the time that lies between", () => {
  const motion = moving([[1, 2, 0.5, 0]], [[1.1, 1.9, 0.7, 1]]);
  expect(poses(motion, 1100)).toEqual([1, 2, 0.5, 1]);
  expect(poses(motion, 1150)).toEqual([1.05, 1.95, 0.6, 1]);
  expect(motion.at(1150, true)?.time_s).toBeCloseTo(0.55);
  expect(motion.isUnderWay).toBe(true);
});

test("what lies over robots on their way is of the moment that they have come from", () => {
  const over = (tick: number, robots: number[][]): Frame => {
    const told = frame(tick, robots);
    const footprints = { frame: tick, links: new Uint32Array(), footprints: [], robots: told.robots };
    return { ...told, overlay: footprints };
  };
  const motion = new Motion();
  motion.put(over(5, [[1, 2, 0.5, 0]]), 1000, reach);
  motion.at(1000, true);
  motion.put(over(6, [[1.1, 1.9, 0.7, 1]]), 1100, reach);
  expect(motion.at(1150, true)?.overlay?.frame).toBe(5);
  expect(Array.from(motion.at(1150, true)?.overlay?.robots ?? []).slice(0, 2)).toEqual([1, 2]);
  expect(motion.at(1200, true)?.overlay?.frame).toBe(6);
});

test("nothing is drawn beyond what has been told, however late the next frame is", () => {
  const motion = moving([[1, 2, 0, 0]], [[1.1, 2, 0, 0]]);
  for (const now_ms of [1200, 1300, 9000]) expect(poses(motion, now_ms)).toEqual([1.1, 2, 0, 0]);
  expect(motion.isUnderWay).toBe(false);
});

test("a frame that comes early is set out for from where robots are drawn", () => {
  const motion = moving([[1, 2, 0, 0]], [[1.1, 2, 0, 0]]);
  poses(motion, 1150);
  motion.put(frame(7, [[1.2, 2, 0, 0]]), 1150, reach);
  expect(poses(motion, 1150)).toEqual([1.05, 2, 0, 0]);
  expect(poses(motion, 1175)).toEqual([1.125, 2, 0, 0]);
});

test("a heading turns the shortest way", () => {
  const motion = moving([[1, 2, 3.1, 0]], [[1, 2, -3.1, 0]]);
  expect(Math.abs(poses(motion, 1150)[2] ?? 0)).toBeCloseTo(Math.PI, 2);
});

test("what comes farther than it could has jumped, and others are on their way", () => {
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

test("in a stand, and for who wants no motion, all are where they have been told to be", () => {
  const motion = moving([[1, 2, 0, 0]], [[1.1, 2, 0, 0]]);
  expect(poses(motion, 1150, false)).toEqual([1.1, 2, 0, 0]);
  expect(motion.isUnderWay).toBe(false);
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
])("a frame %s is drawn as it comes", (_, to, generation, now_ms) => {
  expect(poses(moving([[1, 2, 0, 0]], to, generation), now_ms)).toEqual(to.flat());
});

test.each([
  ["back in time", 4, 1100],
  ["close upon the last", 6, 1030],
  ["after a stand", 6, 9000],
])("a frame %s is drawn as it comes", (_, tick, now_ms) => {
  const motion = new Motion();
  motion.put(frame(5, [[1, 2, 0, 0]]), 1000, reach);
  motion.at(1000, true);
  motion.put(frame(tick, [[1.1, 2, 0, 0]]), now_ms, reach);
  expect(poses(motion, now_ms)).toEqual([1.1, 2, 0, 0]);
});

test("the reach is that of the fastest kind, and half of the world", () => {
  const robots = { slow: { drive: { max_speed_m_s: 1 } }, fast: { drive: { max_speed_m_s: 5 } } };
  const setting = { world: { size: [40, 30] }, document: { robots } } as unknown as Setting;
  expect(reachOf(setting)).toEqual({ speed: 5, most: 15 });
});
