import { expect, test } from "vitest";
import { excerptOf } from "./excerpt";

const lines = (count: number) => Array.from({ length: count }, (_, i) => `line ${i + 1}`).join("\n");
const shown = (text: string, marked: number[]) =>
  excerptOf(text, new Set(marked)).map((part) => ("left" in part ? `-${part.left}` : part.number));

test("a file of usual length is shown whole", () => {
  expect(shown(lines(2000), [7])).toHaveLength(2000);
});

test("of a long file, the first lines and those around errors are shown", () => {
  expect(shown(lines(80_000), [40_000, 40_003])).toEqual([
    ...[1, 2, 3, 4],
    "-39992",
    ...Array.from({ length: 10 }, (_, i) => 39_997 + i),
    "-39994",
  ]);
});

test("an error in the last line is shown, and nothing is left out after it", () => {
  expect(shown(lines(3000), [3000]).slice(-4)).toEqual([2997, 2998, 2999, 3000]);
});

test("an error without a line, or behind the text, hides nothing", () => {
  const excerpt = excerptOf(lines(2001), new Set([null, 9999]));
  expect(excerpt.at(-1)).toEqual({ left: 1997 });
});
