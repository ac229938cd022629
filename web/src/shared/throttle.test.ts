import { expect, test } from "vitest";
import { Throttle } from "./throttle";

function throttled(merge = (_: number, latest: number) => latest) {
  const sent: [string, number][] = [];
  const waits: (() => void)[] = [];
  const throttle = new Throttle<number>(
    50,
    (key, value) => sent.push([key, value]),
    merge,
    (_, action) => waits.push(action),
  );
  return { throttle, sent, tick: () => waits.shift()?.() };
}

test("the first value is sent at once", () => {
  const { throttle, sent } = throttled();
  throttle.put("a", 1);
  expect(sent).toEqual([["a", 1]]);
});

test("while waiting, the latest value is kept and sent", () => {
  const { throttle, sent, tick } = throttled();
  for (const value of [1, 2, 3, 4]) throttle.put("a", value);
  tick();
  tick();
  expect(sent).toEqual([
    ["a", 1],
    ["a", 4],
  ]);
});

test("skipped values are merged into the latest one", () => {
  const { throttle, sent, tick } = throttled((waiting, latest) => waiting + latest);
  for (const value of [1, 2, 3, 4]) throttle.put("a", value);
  tick();
  expect(sent).toEqual([
    ["a", 1],
    ["a", 9],
  ]);
});

test("keys do not displace each other", () => {
  const { throttle, sent, tick } = throttled();
  throttle.put("a", 1);
  throttle.put("b", 2);
  throttle.put("c", 3);
  throttle.put("b", 4);
  tick();
  tick();
  expect(sent).toEqual([
    ["a", 1],
    ["c", 3],
    ["b", 4],
  ]);
});
