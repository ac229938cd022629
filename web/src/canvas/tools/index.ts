import { circle } from "./circle";
import { item } from "./item";
import { move } from "./move";
import { rectangle } from "./rectangle";
import { remove } from "./remove";
import type { Tool } from "./tool";

/** Ways to change the world by hand; `select` is none of them: it chooses robots and moves the picture. */
export const tools = { move, circle, rectangle, item, remove } satisfies Record<string, Tool>;

export type ToolId = keyof typeof tools | "select";
export const toolIds = Object.keys(tools) as (keyof typeof tools)[];

export function toolOf(id: ToolId): Tool | null {
  return id === "select" ? null : tools[id];
}
