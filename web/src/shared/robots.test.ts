import { expect, test } from "vitest";
import { maxLinks } from "../api/overlay";
import { sendersOf } from "./robots";

test("a robot receives over links towards it and over two-way links", () => {
  const links = Uint32Array.from([0, 1, 1, 2, 0, 0, 0, 3, 0]);
  expect([0, 1, 2, 3, 4].map((robot) => sendersOf(links, robot))).toEqual([2, 1, 0, 1, 0]);
});

test("the number of senders is unknown if links may be missing", () => {
  expect(sendersOf(new Uint32Array(3 * maxLinks), 0)).toBeNull();
});
