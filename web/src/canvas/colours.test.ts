import { expect, test } from "vitest";
import { inFull, rgb } from "./colours";

test("colours that were shortened are the same colours", () => {
  expect(inFull("#fff")).toBe("#ffffff");
  expect(inFull("#1a5")).toBe("#11aa55");
  expect(inFull("#1a5fd0")).toBe("#1a5fd0");
});

test("a colour is split into red, green and blue", () => {
  expect(rgb("#ff0033")).toEqual([1, 0, 0.2]);
});
