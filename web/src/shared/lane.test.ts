import { expect, test } from "vitest";
import type { LaneView, MarkView, Setting } from "../api/protocol";
import {
  borderOf,
  calledOffPath,
  cellsOf,
  clearedShare,
  hasLane,
  isBelievedMine,
  laneOf,
  markCounts,
  percent,
  riskLabel,
  shadeOf,
  statementLabel,
  ticksOf,
  truthLabel,
} from "./lane";

const lane = (rest: Partial<LaneView> = {}): LaneView => ({
  controller: "station/0",
  corners: [
    [6, 2],
    [12, 6],
  ],
  cell_m: 2,
  columns: 3,
  rows: 2,
  expected: btoa(String.fromCharCode(0, 51, 52, 204, 255, 0)),
  scale: { min: 1e-5, max: 1, cleared: 51 },
  marks: [],
  risk: { unmarked: 0.021, marked: 0.0101, probability: 0.0306 },
  declare_below: 0.05,
  statement: null,
  cleared: [],
  passage: null,
  ...rest,
});
const mark = (rest: Partial<MarkView> = {}): MarkView => ({
  number: 0,
  at: [7, 3],
  deviation_m: 0.3,
  mine: 0.2,
  verdict: null,
  failed_charges: 0,
  ...rest,
});
const documentOf = (document: object) => ({ document }) as Setting;

test("a run has a lane if one of its controllers is to clear it", () => {
  expect(hasLane(documentOf({ controllers: { base: {}, station: { clearance: {} } } }))).toBe(true);
  expect(hasLane(documentOf({ controllers: { base: {} } }))).toBe(false);
  expect(hasLane(documentOf({}))).toBe(false);
});

test("a person ends the mission of the kind of controllers that has a lane", () => {
  const setting = documentOf({ controllers: { base: {}, station: { clearance: {} } } });
  expect(calledOffPath(setting)).toBe("controllers.station.clearance.called_off");
});

test("the first controller is shown until another one is chosen", () => {
  const all = [lane(), lane({ controller: "station/1" })];
  const lanes = { tick: 0, mines_left: 2, vehicles: [], lanes: all, type: "lanes" as const };
  expect(laneOf(lanes, null)).toBe(all[0]);
  expect(laneOf(lanes, "station/1")).toBe(all[1]);
  // It was removed from the scenario.
  expect(laneOf(lanes, "station/7")).toBe(all[0]);
  expect(laneOf(null, "station/0")).toBeNull();
});

test("cells are decoded, and those up to the scale's byte are cleared", () => {
  expect([...cellsOf(lane())]).toEqual([0, 51, 52, 204, 255, 0]);
  expect(clearedShare(lane())).toBe(0.5);
});

test("the colour scale covers three decades above the value of a cleared cell", () => {
  const { scale } = lane();
  expect([0, 51, 204, 255].map((byte) => shadeOf(scale, byte))).toEqual([0, 0, 1, 1]);
  expect(shadeOf(scale, 102)).toBeCloseTo(1 / 3);
});

test("the legend has the powers of ten within the colour scale", () => {
  expect(ticksOf({ min: 5.13e-5, max: 5.13, cleared: 51 }).map(({ label }) => label)).toEqual([
    "0.001",
    "0.01",
    "0.1",
  ]);
  const [first] = ticksOf({ min: 5.13e-5, max: 5.13, cleared: 51 });
  // log10(0.001 / 0.000513) of three decades.
  expect(first?.place).toBeCloseTo(0.29 / 3, 2);
});

test("the outline of the cleared path separates cleared cells from all others", () => {
  const sides = borderOf(lane()).map(([from, to]) => `${from} ${to}`);
  // Cells 0 and 1 of the lower row together, and the last one of the upper row.
  expect(sides.sort()).toEqual(
    [
      "0,0 0,1",
      "2,0 2,1",
      "0,0 1,0",
      "1,0 2,0",
      "0,1 1,1",
      "1,1 2,1",
      "2,1 2,2",
      "3,1 3,2",
      "2,1 3,1",
      "2,2 3,2",
    ].sort(),
  );
});

test("marks are counted by state, and only those that occur", () => {
  expect(markCounts([mark(), mark(), mark({ verdict: "isolated" })])).toBe("2 unverified, 1 isolated");
  expect(markCounts([])).toBe("no marks");
  expect([mark({ mine: 0.49 }), mark({ mine: 0.5 })].map(isBelievedMine)).toEqual([false, true]);
});

test("the panel states the risk, its parts and what has been declared", () => {
  expect(riskLabel(lane())).toBe("Remaining risk 3.1%: 0.021 mines expected without a mark, 0.010 at marks.");
  expect(statementLabel(lane())).toBe("No statement yet: it declares the lane clear below 5%.");
  const clear = { is_clear: true, at_s: 412, risk: 0.046 };
  expect(statementLabel(lane({ statement: clear }))).toBe("Declared clear at 412.0 s, at a risk of 4.6%.");
  expect(statementLabel(lane({ statement: { ...clear, is_clear: false, risk: 1 } }))).toBe(
    "Given up at 412.0 s, at a risk of over 99.9%.",
  );
  expect([0, 1, 2].map(truthLabel)).toEqual([
    "No mines left in the lane.",
    "1 mine left in the lane.",
    "2 mines left in the lane.",
  ]);
});

test("a probability is never rounded to certainty", () => {
  expect([0, 1e-6, 2e-4, 0.0306, 0.63, 0.9995].map(percent)).toEqual([
    "0%",
    "under 0.01%",
    "0.02%",
    "3.1%",
    "63%",
    "over 99.9%",
  ]);
});
