import { expect, test } from "vitest";
import type { Change } from "../api/protocol";
import {
  damagesOf,
  emptyLink,
  type Link,
  newStudyLink,
  readLink,
  shortened,
  studyLink,
  writeLink,
} from "./link";

const read = (hash: string) => readLink(new URLSearchParams(hash.slice(hash.indexOf("?") + 1)));

const full: Link = {
  scenario: "mine/room & hall.toml",
  text: null,
  study: null,
  recording: null,
  live: false,
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
  charts: ["outcome/found", "body/rover/0/x_m"],
};

test.each([
  ["full", full],
  ["empty", emptyLink],
  ["with a scenario of its own", { ...emptyLink, text: "zAb-_9" }],
  ["of a study with its own seed", { ...emptyLink, study: { id: "a", configuration: 0 }, seed: null }],
  ["of a study", { ...emptyLink, study: { id: "studies/mine & yours", configuration: 12 }, run: "7" }],
  ["of a recording", { ...emptyLink, recording: "recordings/a b.mcap", changes: null, tick: 3 }],
  [
    "live",
    { ...emptyLink, live: true, seed: null, view: [1, 2, 3] as [number, number, number], robot: "bender/0" },
  ],
  ["of a recording with other changes", { ...emptyLink, recording: "a.mcap", changes: [] }],
])("a link that is %s survives a round trip", (_, link) => expect(read(writeLink(link))).toEqual(link));

const damages = (query: string) => damagesOf(new URLSearchParams(query));

test.each([
  ["seed=-1"],
  ["run=x"],
  ["tick=1.5"],
  ["tick=99999999999999999999"],
  ["view=1,2"],
  ["changes={not json"],
  ["changes=[[1]]"],
  ['changes=[[5,"p",0],[-1,"p",0]]'],
])("an address with a damaged part names it: %s", (part) =>
  expect(damages(`scenario=a&${part}`)).toEqual([part]),
);

test("an address has exactly one source, and a study its configuration", () => {
  expect(damages("seed=1")).toHaveLength(1);
  expect(damages("scenario=a&recording=b")).toEqual(["scenario, recording: only one of them can be opened"]);
  expect(damages("study=studies/a")).toEqual(["configuration: it is missing"]);
  expect(damages("study=studies/a&configuration=-1")).toEqual(["configuration=-1"]);
});

test("the live run is opened as it is: its address has nothing else to open", () => {
  expect(writeLink({ ...full, scenario: null, live: true })).toBe(
    "#/run?live=1&view=12.5,8,31.25&robot=rover/3&chart=outcome/found&chart=body/rover/0/x_m",
  );
  expect(damages("live=1&robot=bender/0")).toEqual([]);
  expect(damages("live=yes")).toEqual(["live=yes"]);
  expect(damages("scenario=a&live=1")).toEqual(["scenario, live: only one of them can be opened"]);
  expect(damages("live=1&tick=40&seed=7")).toEqual([
    "seed: a live run is opened as it is",
    "tick: a live run is opened as it is",
  ]);
});

test("a long damaged part is shortened", () => {
  const [line] = damages(`scenario=a&changes=[${"1,".repeat(500)}`);
  expect(line?.length).toBeLessThan(80);
});

test("addresses that the page writes are not damaged", () => {
  for (const link of [full, { ...emptyLink, recording: "a.mcap", changes: null }, { ...full, live: true }])
    expect(damages(writeLink(link).slice("#/run?".length))).toEqual([]);
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
