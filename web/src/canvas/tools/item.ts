import { ring } from "../layers/layer";
import { itemsEdit, placesOf } from "./editing";
import type { Tool } from "./tool";

export const item: Tool = {
  label: "Add item",
  help: "Press where it is to lie. All items of its kind then stay where they are now.",
  grips: ({ itemKind }) => itemKind !== "",
  ghost({ reach }, _, to) {
    const path = new Path2D();
    ring(path, to, reach * 0.6);
    return path;
  },
  edit: ({ setting, itemKind }, _, to) => itemsEdit(setting, itemKind, [...placesOf(setting, itemKind), to]),
};
