import { ring } from "../layers/layer";
import { itemsEdit, positionsOf } from "./editing";
import type { Tool } from "./tool";

export const item: Tool = {
  label: "Add item",
  help: "Click the position. All items of this kind then keep their current positions.",
  canStart: ({ itemKind }) => itemKind !== "",
  preview({ tolerance }, _, to) {
    const path = new Path2D();
    ring(path, to, tolerance * 0.6);
    return path;
  },
  edit: ({ setting, itemKind }, _, to) =>
    itemsEdit(setting, itemKind, [...positionsOf(setting, itemKind), to]),
};
