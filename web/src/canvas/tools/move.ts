import type { Point } from "../../api/protocol";
import { ring } from "../layers/layer";
import { addObstacle, itemsEdit, moved, obstaclesEdit, objectAt } from "./editing";
import type { EditContext, Edit, Tool } from "./tool";

export const move: Tool = {
  label: "Move",
  help: "Drag an obstacle or item.",
  canStart: (context, at) => objectAt(context, at) !== null,
  preview(context, from, to) {
    const object = objectAt(context, from);
    const path = new Path2D();
    if (object && "item" in object) ring(path, to, context.tolerance * 0.6);
    else if (object) addObstacle(path, context.world, object.obstacle, [to[0] - from[0], to[1] - from[1]]);
    return path;
  },
  edit(context, from, to) {
    const object = objectAt(context, from);
    if (!object || (from[0] === to[0] && from[1] === to[1])) return null;
    return "item" in object
      ? movedItem(context, object.item, to)
      : movedObstacle(context, object.obstacle, from, to);
  },
};

function movedItem({ setting }: EditContext, index: number, to: Point): Edit | null {
  const chosen = setting.items[index];
  if (!chosen) return null;
  const same = setting.items.filter((item) => item.kind === chosen.kind);
  return itemsEdit(
    setting,
    chosen.kind,
    same.map((item) => (item === chosen ? to : item.at)),
  );
}

function movedObstacle({ world }: EditContext, index: number, from: Point, to: Point): Edit {
  return obstaclesEdit(
    world.obstacles.map((one, i) => (i === index ? moved(one, to[0] - from[0], to[1] - from[1]) : one)),
  );
}
