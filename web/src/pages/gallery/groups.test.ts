import { expect, test } from "vitest";
import type { ScenarioEntry } from "../../api/protocol";
import { groupsOf } from "./groups";

function entry(id: string, group: string): ScenarioEntry {
  return { id, name: id, engine: "metric", summary: "", where: "bundled", group };
}

test("entries are grouped in their order", () => {
  const entries = [entry("a", "Start here"), entry("b", "Mines"), entry("c", "Mines")];
  const ids = groupsOf(entries).map(({ title, entries }) => [title, entries.map(({ id }) => id)]);
  expect(ids).toEqual([
    ["Start here", ["a"]],
    ["Mines", ["b", "c"]],
  ]);
});

test("a group whose entries are apart is one group", () => {
  const entries = [entry("a", "Mines"), entry("b", "Real robots"), entry("c", "Mines")];
  expect(groupsOf(entries).map(({ title }) => title)).toEqual(["Mines", "Real robots"]);
});

test("without entries there are no groups", () => {
  expect(groupsOf([])).toEqual([]);
});
