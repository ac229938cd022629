import { expect, test } from "vitest";
import type { Change } from "../api/protocol";
import { emptyLink, type Link, newStudyLink, readLink, shortened, studyLink, writeLink } from "./link";

const read = (hash: string) => readLink(new URLSearchParams(hash.slice(hash.indexOf("?") + 1)));

const full: Link = {
  scenario: "mine/room & hall.toml",
  text: null,
  study: null,
  recording: null,
  seed: "18446744073709551615",
  run: "3",
  changes: [
    [0, "robots.rover.count", 12],
    [40, "world.obstacles", [{ circle: { at_m: [1.5, -2], radius_m: 0.5 } }]],
    [41, "robots.rover.brain.behaviours", [{ kind: "bayesian_search" }]],
  ],
  tick: 512,
  view: [12.5, 8, 31.25],
  robot: "rover/3",
};

test.each([
  ["full", full],
  ["empty", emptyLink],
  ["with a scenario of its own", { ...emptyLink, text: "zAb-_9" }],
  ["of a study with its own seed", { ...emptyLink, study: { id: "a", configuration: 0 }, seed: null }],
  ["of a study", { ...emptyLink, study: { id: "studies/mine & yours", configuration: 12 }, run: "7" }],
  ["of a recording", { ...emptyLink, recording: "recordings/a b.mcap", changes: null, tick: 3 }],
  ["of a recording with other changes", { ...emptyLink, recording: "a.mcap", changes: [] }],
])("a link that is %s survives a round trip", (_, link) => expect(read(writeLink(link))).toEqual(link));

test("invalid parts of an address are ignored", () => {
  const hash =
    "#/run?scenario=a&seed=-1&run=x&tick=1.5&view=1,2&changes=[[1],[2,3,4],[-1,%22p%22,0],[5,%22p%22,0]]";
  expect(read(hash)).toEqual({ ...emptyLink, scenario: "a", changes: [[5, "p", 0]] });
  expect(read("#/run?changes={not json").changes).toEqual([]);
});

test("a study without a configuration number does not define a run", () => {
  expect(read("#/run?study=studies/a").study).toBeNull();
  expect(read("#/run?study=studies/a&configuration=-1").study).toBeNull();
});

test("the address of a study shows its folder unescaped", () => {
  expect(studyLink("studies/classic-12", 3)).toBe("#/study?id=studies/classic-12&configuration=3");
  expect(newStudyLink({ scenario: "mine/hall.toml", text: null })).toBe(
    "#/study/new?scenario=mine/hall.toml",
  );
});

test("of several changes of a path at one tick the last remains", () => {
  expect(
    shortened([
      [1, "a", 1],
      [1, "a", 2],
      [1, "a.b", 3],
      [2, "a", 4],
    ]),
  ).toEqual([
    [1, "a", 2],
    [1, "a.b", 3],
    [2, "a", 4],
  ]);
});

test("a change of a part is dropped if the whole is replaced later at the same tick", () => {
  expect(
    shortened([
      [1, "items.mine.count", 1],
      [1, "items.mine", { count: 2 }],
    ]),
  ).toEqual([[1, "items.mine", { count: 2 }]]);
});

test("an address keeps all changes of a tick: robots that were removed and added again are new ones", () => {
  const changes: Change[] = [0, 12].map((count) => [7, "robots.rover.count", count]);
  expect(read(writeLink({ ...full, changes })).changes).toEqual(changes);
});
