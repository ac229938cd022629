import { expect, test } from "vitest";
import { maxLinks } from "../api/overlay";
import type { Setting } from "../api/protocol";
import { externalOf, sendersOf } from "./robots";

test("robots with external bodies are found by their names, as far as they are in the team", () => {
  const setting = { robots: ["rover/0", "rover/1"], external: ["rover/1", "rover/7"] } as Setting;
  expect(externalOf(setting)).toEqual([1]);
});

test("a robot receives over links towards it and over two-way links", () => {
  const links = Uint32Array.from([0, 1, 1, 2, 0, 0, 0, 3, 0]);
  expect([0, 1, 2, 3, 4].map((robot) => sendersOf(links, robot))).toEqual([2, 1, 0, 1, 0]);
});

test("the number of senders is unknown if links may be missing", () => {
  expect(sendersOf(new Uint32Array(3 * maxLinks), 0)).toBeNull();
});
