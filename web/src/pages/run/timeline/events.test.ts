import { expect, test } from "vitest";
import type { EventRow, Setting, VersionView } from "../../../api/protocol";
import { type Entry, countUntil, counted, entriesOf, filtered, neighbour, withArrived } from "./events";
import { branchTicks, tree } from "./versions";

const event = (tick: number, kind = "found", of = `mine/${tick}`): EventRow => ({
  tick,
  kind,
  of,
  text: kind,
  agent: "rover/0",
});
const version = (number: number, parent: number | null, tick = 0): VersionView => ({
  number,
  parent,
  tick,
  path: parent === null ? "" : "robots.rover.count",
  value: String(number),
  latest_tick: 100,
});
const setting = (versions: VersionView[], current: number) =>
  ({ versions, version: current }) as unknown as Setting;
const answer = (since: number, rows: EventRow[]) => ({ type: "events" as const, since, rows, one_of: {} });

test("rows replace all rows from their first tick on", () => {
  const first = withArrived([], answer(0, [event(1), event(5)]));
  expect(withArrived(first, answer(6, [event(9)])).map(({ tick }) => tick)).toEqual([1, 5, 9]);
  expect(withArrived(first, answer(5, [event(7)])).map(({ tick }) => tick)).toEqual([1, 7]);
  expect(withArrived(first, answer(0, []))).toEqual([]);
});

test("changes of the current version stand among the events, and those of other branches do not", () => {
  const versions = [version(0, null), version(1, 0, 4), version(2, 1, 8), version(3, 1, 6)];
  const entries = entriesOf([event(5), event(8)], setting(versions, 3));
  expect(entries.map(({ at, kind }) => `${at} ${kind}`)).toEqual([
    "4 changed",
    "6 found",
    "6 changed",
    "9 found",
  ]);
});

test("entries are filtered by kind and by text, whatever its case", () => {
  const entries = entriesOf([event(1), event(2, "collided", "rover/7")], setting([version(0, null)], 0));
  const ticks = (found: Entry[]) => found.map(({ tick }) => tick);
  expect(ticks(filtered(entries, new Set(["found"]), ""))).toEqual([1]);
  expect(ticks(filtered(entries, new Set(["found", "collided"]), " ROVER/7 "))).toEqual([2]);
  expect(ticks(filtered(entries, new Set(["found", "collided"]), "rover/0"))).toEqual([1, 2]);
});

test("only kinds with events are counted, in the order in which they are offered", () => {
  const kind = (id: string) => ({ id, label: id, colour: "accent" as const, is_on: true });
  const entries = entriesOf([event(1), event(2), event(3, "sent")], setting([version(0, null)], 0));
  const found = counted(entries, ["sent", "failed", "found"].map(kind));
  expect(found.map(({ id, count }) => `${id} ${count}`)).toEqual(["sent 1", "found 2"]);
});

test("the next and the previous event are those after and before the tick", () => {
  const entries = entriesOf([event(1), event(5), event(5), event(9)], setting([version(0, null)], 0));
  expect(neighbour(entries, 2, 1)?.at).toBe(6);
  expect(neighbour(entries, 6, -1)?.at).toBe(2);
  expect(neighbour(entries, 10, 1)).toBeUndefined();
  expect([0, 2, 6, 10].map((tick) => countUntil(entries, tick))).toEqual([0, 1, 3, 4]);
});

test("the versions are a tree in which the current one continues its column", () => {
  const versions = [version(0, null), version(1, 0, 4), version(2, 1, 8), version(3, 1, 6), version(4, 0, 2)];
  const shown = (current: number) =>
    tree(setting(versions, current)).map(
      ({ version: { number }, depth, isOn }) => `${number} ${depth} ${isOn}`,
    );
  expect(shown(3)).toEqual(["0 0 true", "4 1 false", "1 0 true", "2 1 false", "3 0 true"]);
  expect(branchTicks(setting(versions, 3))).toEqual([8, 2]);
  expect(branchTicks(setting(versions, 0))).toEqual([4, 2]);
});
