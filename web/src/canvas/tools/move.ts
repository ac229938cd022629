import type { Point } from "../../api/protocol";
import { ring } from "../layers/layer";
import { addObstacle, itemsEdit, moved, obstaclesEdit, thingAt } from "./editing";
import type { Bench, Edit, Tool } from "./tool";

export const move: Tool = {
  label: "Move",
  help: "Drag an obstacle or item.",
  grips: (bench, at) => thingAt(bench, at) !== null,
  ghost(bench, from, to) {
    const thing = thingAt(bench, from);
    const path = new Path2D();
    if (thing && "item" in thing) ring(path, to, bench.reach * 0.6);
    else if (thing)
      addObstacle(path, moved(bench.world.obstacles[thing.obstacle] ?? {}, to[0] - from[0], to[1] - from[1]));
    return path;
  },
  edit(bench, from, to) {
    const thing = thingAt(bench, from);
    if (!thing || (from[0] === to[0] && from[1] === to[1])) return null;
    return "item" in thing
      ? movedItem(bench, thing.item, to)
      : movedObstacle(bench, thing.obstacle, from, to);
  },
};

function movedItem({ setting }: Bench, index: number, to: Point): Edit | null {
  const chosen = setting.items[index];
  if (!chosen) return null;
  const same = setting.items.filter((item) => item.kind === chosen.kind);
  return itemsEdit(
    setting,
    chosen.kind,
    same.map((item) => (item === chosen ? to : item.at)),
  );
}

function movedObstacle({ world }: Bench, index: number, from: Point, to: Point): Edit {
  return obstaclesEdit(
    world.obstacles.map((one, i) => (i === index ? moved(one, to[0] - from[0], to[1] - from[1]) : one)),
  );
}
