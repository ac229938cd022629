import { itemsEdit, obstaclesEdit, outlineOf, positionsOf, type WorldObject, objectAt } from "./editing";
import type { EditContext, Edit, Tool } from "./tool";

export const remove: Tool = {
  label: "Remove",
  help: "Click an obstacle or item.",
  canStart: (context, at) => objectAt(context, at) !== null,
  preview(context, from) {
    const object = objectAt(context, from);
    return object ? outlineOf(context.world, context.setting, object, context.tolerance) : null;
  },
  edit(context, from) {
    const object = objectAt(context, from);
    return object ? removal(context, object) : null;
  },
};

export function removal(
  { setting, world }: Pick<EditContext, "setting" | "world">,
  object: WorldObject,
): Edit | null {
  if ("obstacle" in object) return obstaclesEdit(world.obstacles.filter((_, i) => i !== object.obstacle));
  const chosen = setting.items[object.item];
  return chosen ? itemsEdit(setting, chosen.kind, positionsOf(setting, chosen.kind, chosen)) : null;
}
