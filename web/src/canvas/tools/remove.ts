import { itemsEdit, obstaclesEdit, pathOf, placesOf, type Thing, thingAt } from "./editing";
import type { Bench, Edit, Tool } from "./tool";

export const remove: Tool = {
  label: "Remove",
  help: "Press on an obstacle or item.",
  grips: (bench, at) => thingAt(bench, at) !== null,
  ghost(bench, from) {
    const thing = thingAt(bench, from);
    return thing ? pathOf(bench.world, bench.setting, thing, bench.reach) : null;
  },
  edit(bench, from) {
    const thing = thingAt(bench, from);
    return thing ? removal(bench, thing) : null;
  },
};

export function removal({ setting, world }: Pick<Bench, "setting" | "world">, thing: Thing): Edit | null {
  if ("obstacle" in thing) return obstaclesEdit(world.obstacles.filter((_, i) => i !== thing.obstacle));
  const chosen = setting.items[thing.item];
  return chosen ? itemsEdit(setting, chosen.kind, placesOf(setting, chosen.kind, chosen)) : null;
}
