import { expect, test } from "vitest";
import type { Setting } from "../../api/protocol";
import { worldOf } from "../../shared/world";
import { itemsEdit, moved, obstacleLabel, positionsOf, objectAt } from "./editing";
import { removal } from "./remove";
import type { EditContext } from "./tool";

const setting: Setting = {
  type: "setting",
  generation: 1,
  step_s: 0.1,
  world: { size: [20, 20], periodic: false, unit: "m", cell: null },
  document: {
    world: {
      obstacles: [
        {
          polygon_m: [
            [0, 0],
            [10, 0],
            [10, 10],
            [5, 2],
            [0, 10],
          ],
        },
        { circle: { at_m: [15, 15], radius_m: 2 }, repeat: { rows: 2, spacing_m: [0, -10] } },
      ],
    },
    items: { mine: { count: 2, target: true } },
  },
  robots: [],
  kinds: [],
  items: [
    { kind: "mine", at: [15, 15], target: true, contact: [] },
    { kind: "scrap", at: [1, 19], target: false, contact: [] },
  ],
  obstacles: [
    {
      entry: 0,
      polygon: [
        [0, 0],
        [10, 0],
        [10, 10],
        [5, 2],
        [0, 10],
      ],
      circle: null,
    },
    { entry: 1, polygon: null, circle: { at: [15, 15], radius: 2 } },
    { entry: 1, polygon: null, circle: { at: [15, 5], radius: 2 } },
  ],
  maps: [],
  offer: { layers: [], panels: [], events: [], signals: [], robot_signals: [], columns: [] },
  versions: [],
  version: 0,
  can_redo: false,
  item_kinds: ["mine"],
  parameters: [],
  external: [],
  changes: [],
  log: [],
};
const context: EditContext = { setting, world: worldOf(setting), tolerance: 0.5, itemKind: "mine" };

test("an item takes precedence over the obstacle below it", () => {
  expect(objectAt(context, [15.2, 15])).toEqual({ item: 0 });
  expect(objectAt(context, [16, 16])).toEqual({ obstacle: 1 });
});

test("a copy of an obstacle belongs to the entry that it repeats", () => {
  expect(objectAt(context, [15, 6])).toEqual({ obstacle: 1 });
  expect(removal(context, { obstacle: 1 })?.value).toHaveLength(1);
  expect(obstacleLabel(context.world, 0)).toBe("polygon at 0, 0");
  expect(obstacleLabel(context.world, 1)).toBe("2 circles from 15, 15");
});

test("the notch of a polygon is outside it", () => {
  expect(objectAt(context, [1, 1])).toEqual({ obstacle: 0 });
  expect(objectAt(context, [5, 6])).toBeNull();
});

test("placing an item fixes all items of its kind, and keeps their other keys", () => {
  expect(itemsEdit(setting, "mine", [...positionsOf(setting, "mine"), [3.00049, 4]])).toEqual({
    path: "items.mine",
    value: {
      count: 2,
      target: true,
      placement: {
        kind: "fixed",
        at_m: [
          [15, 15],
          [3, 4],
        ],
      },
    },
  });
});

test("moving shifts all corners, and a map stays in place", () => {
  expect(
    moved(
      {
        polygon_m: [
          [0, 0],
          [1, 0],
          [0, 1],
        ],
      },
      2,
      -1,
    ),
  ).toEqual({
    polygon_m: [
      [2, -1],
      [3, -1],
      [2, 0],
    ],
  });
  expect(moved({ circle: { at_m: [1, 1], radius_m: 2 } }, 1, 1)).toEqual({
    circle: { at_m: [2, 2], radius_m: 2 },
  });
  const repeat = { columns: 3, spacing_m: [4, 0] };
  expect(moved({ rectangle: { at_m: [1, 1], size_m: [2, 3] }, repeat }, 1, 2)).toEqual({
    rectangle: { at_m: [2, 3], size_m: [2, 3] },
    repeat,
  });
  expect(moved({ map: "room.yaml" }, 1, 1)).toEqual({ map: "room.yaml" });
});
