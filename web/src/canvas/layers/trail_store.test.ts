import { expect, test } from "vitest";
import type { Frame } from "../../api/frames";
import { Trails } from "./trail_store";

function frame(time_s: number, xs: number[]): Frame {
  const robots = Float32Array.from(xs.flatMap((x) => [x, 0, 0, 0]));
  return { generation: 1, tick: 0, time_s, number: 0, count: xs.length, robots, items: new Uint8Array() };
}

const places = (trails: Trails) => trails.inOrder().map((sample) => [sample.time_s, sample.places[0]]);

test("a trail is ordered from oldest to newest", () => {
  const trails = new Trails();
  for (const time of [0, 1, 2]) trails.put(frame(time, [time * 10]), -1);
  expect(places(trails)).toEqual([
    [0, 0],
    [1, 10],
    [2, 20],
  ]);
});

test("positions older than the span are dropped", () => {
  const trails = new Trails();
  for (let time = 0; time < 200; time += 0.25) trails.put(frame(time, [time]), -1);
  const kept = places(trails);
  expect(kept.length).toBe(48);
  expect(kept[0]?.[0]).toBe(188);
});

test("going back in time starts a new trail", () => {
  const trails = new Trails();
  for (const time of [0, 1, 2, 0.5]) trails.put(frame(time, [time]), -1);
  expect(places(trails)).toEqual([[0.5, 0.5]]);
});

test("with many robots only the selected one has a trail", () => {
  const trails = new Trails();
  const many = (time: number) =>
    frame(
      time,
      Array.from({ length: 1000 }, (_, i) => i + time),
    );
  trails.put(many(0), -1);
  expect(trails.isEmpty).toBe(true);
  trails.put(many(1), 500);
  trails.put(many(2), 500);
  expect(places(trails)).toEqual([
    [1, 501],
    [2, 502],
  ]);
});
