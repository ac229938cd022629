import { expect, test } from "vitest";
import type { Frame } from "../net/frames";
import { Arrivals } from "./arrivals";

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

test("of frames that come faster than they are drawn the latest is taken, and acknowledged for all", () => {
  const acknowledged: number[] = [];
  const arrivals = new Arrivals((number) => acknowledged.push(number));
  for (const number of [1, 2, 3]) arrivals.put(frame(number));
  expect(acknowledged).toEqual([]);
  const taken = arrivals.take(1);
  expect(taken?.number).toBe(3);
  if (taken) arrivals.drawn(taken);
  expect(acknowledged).toEqual([3]);
  expect(arrivals.take(1)).toBeNull();
});

test("a frame of another generation is acknowledged and not shown", () => {
  const acknowledged: number[] = [];
  const arrivals = new Arrivals((number) => acknowledged.push(number));
  arrivals.put(frame(1, 2));
  expect(arrivals.take(1)).toBeNull();
  expect(arrivals.shown).toBeNull();
  expect(acknowledged).toEqual([1]);
});
