import { expect, test } from "vitest";
import type { PassageView, Setting, VehicleView } from "../api/protocol";
import { clearedLabel, hasPassage, passageLabel, pathLabel, vehiclesLabel } from "./passage";

const passage = (risks: number[]): PassageView => ({
  path: [
    [8, 14],
    [208, 14],
  ],
  width_m: 3,
  length_m: 200,
  mines: 0.00421,
  risks,
});

const vehicles = (...statuses: VehicleView["status"][]): VehicleView[] =>
  statuses.map((status, i) => ({ name: `vehicle/${i}`, at: [0, 0], has_entered: true, status }));

test("a run has a passage if its scenario has one", () => {
  const setting = (document: object) => ({ document }) as Setting;
  expect(hasPassage(setting({ passage: { width_m: 3 } }))).toBe(true);
  expect(hasPassage(setting({}))).toBe(false);
});

test("the risks of the first and the last vehicle are stated, and of one vehicle once", () => {
  expect(passageLabel(passage([0.0031]))).toBe("Risk of the first vehicle 0.31%.");
  expect(passageLabel(passage([0.12, 0.02, 0.01]))).toBe("Risk of the first vehicle 12%, last of 3 1%.");
  expect(pathLabel(passage([0.1]))).toBe("Path of 200 m, 3 m wide: 0.00421 mines expected in it.");
});

test("what has become of the vehicles is stated, and whether the first was lost", () => {
  expect(vehiclesLabel(vehicles("passed", "passed"))).toBe("2 vehicles passed, 0 lost.");
  expect(vehiclesLabel(vehicles("lost", "passed", "driving"))).toBe(
    "1 vehicle passed, 1 lost (with the first), 1 driving.",
  );
  expect(vehiclesLabel(vehicles("passed", "lost"))).toBe("1 vehicle passed, 1 lost.");
});

test("the share that is cleared has its interval", () => {
  const share = { kind: "mine", cleared: 5, left: 0.1, share: 0.983, low: 0.8333, high: 1 };
  expect(clearedLabel(share)).toBe("98.3% (95% interval 83.3% to 100%)");
});
