import { expect, test } from "vitest";
import { type ScenarioRow, groupsOf, inOrderOf } from "./groups";

function row(id: string, group: string): ScenarioRow {
  const entry = { id, name: id, engine: "metric", summary: "", where: "bundled", group } as const;
  return { id, name: id, note: "", tags: [], bytes: 0, date_s: 0, state: group, entry };
}

test("scenarios are grouped in their order", () => {
  const rows = [row("a", "Start here"), row("b", "Mines"), row("c", "Mines")];
  const ids = groupsOf(rows).map(({ title, rows }) => [title, rows.map(({ id }) => id)]);
  expect(ids).toEqual([
    ["Start here", ["a"]],
    ["Mines", ["b", "c"]],
  ]);
});

test("a group whose scenarios are apart is one group", () => {
  const rows = [row("a", "Mines"), row("b", "Real robots"), row("c", "Mines")];
  expect(groupsOf(rows).map(({ title }) => title)).toEqual(["Mines", "Real robots"]);
});

test("without scenarios there are no groups", () => {
  expect(groupsOf([])).toEqual([]);
});

test("rows that a filter lets through keep the order of the list", () => {
  const rows = [row("c", "Start here"), row("a", "Mines"), row("b", "Mines")];
  const some = [rows[2], rows[0]].flatMap((each) => each ?? []);
  expect(inOrderOf(rows, some).map(({ id }) => id)).toEqual(["c", "b"]);
});
