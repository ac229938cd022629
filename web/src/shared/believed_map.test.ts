import { expect, test } from "vitest";
import type { MapPart } from "../api/protocol";
import { BelievedMap, runs, unknown } from "./believed_map";

const packed = (...bytes: number[]) => btoa(String.fromCharCode(...bytes));

function part(more: Partial<MapPart>): MapPart {
  return {
    type: "map",
    robot: "rover/0",
    corner: [1, 2],
    cell_m: 0.5,
    columns: 3,
    rows: 2,
    from: [0, 0],
    size: [3, 2],
    occupancy: packed(255, 0, 100, 44, 73, 255),
    unseen: packed(100, 0, 0, 50, 0, 100),
    ...more,
  };
}

test("a part changes its own cells and no others", () => {
  const whole = BelievedMap.with(null, part({}));
  const after = BelievedMap.with(
    whole,
    part({ from: [1, 1], size: [2, 1], occupancy: packed(12, 13), unseen: packed(7, 8) }),
  );
  expect([...after.occupancy]).toEqual([255, 0, 100, 44, 12, 13]);
  expect([...after.unseen]).toEqual([100, 0, 0, 50, 7, 8]);
  expect(after).not.toBe(whole);
});

test("a part of another map replaces all cells", () => {
  const whole = BelievedMap.with(null, part({}));
  const other = part({ columns: 2, rows: 1, size: [1, 1], occupancy: packed(9), unseen: packed(1) });
  expect([...BelievedMap.with(whole, other).occupancy]).toEqual([9, unknown]);
});

test("fractions of free, occupied and unknown cells", () => {
  const { free, occupied, unknown: dark, unseen } = BelievedMap.with(null, part({})).shares();
  expect([free, occupied, dark]).toEqual([2 / 6, 2 / 6, 2 / 6]);
  expect(unseen).toBeCloseTo(250 / 600);
});

test("runs contain each counted cell once, and end with their row", () => {
  const cells = Uint8Array.from([1, 1, 0, 0, 1, 1, 1, 0, 1]);
  expect(runs(cells, 3, (value) => value === 1)).toEqual([
    [0, 0, 2],
    [1, 1, 2],
    [0, 2, 1],
    [2, 2, 1],
  ]);
});
