import { circle } from "./circle";
import { item } from "./item";
import { move } from "./move";
import { rectangle } from "./rectangle";
import { remove } from "./remove";
import type { Tool } from "./tool";

/** The editing tools. `select` is not one of them: it selects robots and pans the view. */
export const tools = { move, circle, rectangle, item, remove } satisfies Record<string, Tool>;

export type ToolId = keyof typeof tools | "select";
export const toolIds = Object.keys(tools) as (keyof typeof tools)[];

export function toolOf(id: ToolId): Tool | null {
  return id === "select" ? null : tools[id];
}
