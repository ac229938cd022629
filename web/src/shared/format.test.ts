import { expect, test } from "vitest";
import { bytes, times } from "./format";

test.each([
  [1, "1 byte"],
  [12_345, "12 kB"],
  [6_292_524, "6.3 MB"],
])("%d bytes are %s", (count, words) => expect(bytes(count)).toBe(words));

test.each([
  [3.14, "3.1"],
  [2.001, "2"],
  [117.6, "118"],
  [0.25, "0.25"],
])("%d times real time is written %s", (factor, words) => expect(times(factor)).toBe(words));
