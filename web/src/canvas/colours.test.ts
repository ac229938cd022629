import { expect, test } from "vitest";
import { expandHex, rgb } from "./colours";

test("shortened colours are expanded", () => {
  expect(expandHex("#fff")).toBe("#ffffff");
  expect(expandHex("#1a5")).toBe("#11aa55");
  expect(expandHex("#1a5fd0")).toBe("#1a5fd0");
});

test("a colour is split into red, green and blue", () => {
  expect(rgb("#ff0033")).toEqual([1, 0, 0.2]);
});
