import { expect, test } from "vitest";
import { mostLinks } from "../api/overlay";
import { heardBy } from "./robots";

test("a robot hears those whose links come to it, and those that it is linked with both ways", () => {
  const links = Uint32Array.from([0, 1, 1, 2, 0, 0, 0, 3, 0]);
  expect([0, 1, 2, 3, 4].map((robot) => heardBy(links, robot))).toEqual([2, 1, 0, 1, 0]);
});

test("of more links than are told nobody knows how many there are", () => {
  expect(heardBy(new Uint32Array(3 * mostLinks), 0)).toBeNull();
});
