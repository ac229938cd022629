import type { Json, Point, Setting } from "../../api/protocol";
import type { World } from "../../shared/world";

/** The data that a tool works on. */
export interface EditContext {
  setting: Setting;
  world: World;
  /** Maximum distance from the pointer at which an object is hit. */
  tolerance: number;
  /** The item kind to place. */
  itemKind: string;
}

/** A change to send. */
export interface Edit {
  path: string;
  value: Json;
}

/** An editing tool, used by pressing, dragging and releasing. */
export interface Tool {
  label: string;
  help: string;
  /** Whether the tool can start here; otherwise a drag pans the view. */
  canStart(context: EditContext, at: Point): boolean;
  /** The shape that the tool would place, in metres. */
  preview(context: EditContext, from: Point, to: Point): Path2D | null;
  edit(context: EditContext, from: Point, to: Point): Edit | null;
}
