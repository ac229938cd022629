import { expect, test } from "vitest";
import type { Frame } from "../api/frames";
import { FrameQueue } from "./frame_queue";

function frame(number: number, generation = 1): Frame {
  return {
    generation,
    number,
    tick: number,
    time_s: 0,
    count: 0,
    robots: new Float32Array(),
    items: new Uint8Array(),
  };
}

test("of several waiting frames the latest is taken, and acknowledged for all", () => {
  const acknowledged: number[] = [];
  const frames = new FrameQueue((number) => acknowledged.push(number));
  for (const number of [1, 2, 3]) frames.put(frame(number));
  expect(acknowledged).toEqual([]);
  const taken = frames.take(1);
  expect(taken?.number).toBe(3);
  if (taken) frames.drawn(taken);
  expect(acknowledged).toEqual([3]);
  expect(frames.take(1)).toBeNull();
});

test("a frame of another generation is acknowledged and not drawn", () => {
  const acknowledged: number[] = [];
  const frames = new FrameQueue((number) => acknowledged.push(number));
  frames.put(frame(1, 2));
  expect(frames.take(1)).toBeNull();
  expect(frames.shown).toBeNull();
  expect(acknowledged).toEqual([1]);
});
