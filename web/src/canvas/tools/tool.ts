import type { Json, Point, Setting } from "../../api/protocol";
import type { World } from "../../shared/world";

/** What a tool works on. */
export interface Bench {
  setting: Setting;
  world: World;
  /** Within this of a thing a pointer is at it. */
  reach: number;
  /** The kind that is placed. */
  itemKind: string;
}

/** What is to be sent. */
export interface Edit {
  path: string;
  value: Json;
}

/** A way to change the world by hand: it is pressed somewhere, drawn along, and let go. */
export interface Tool {
  label: string;
  help: string;
  /** Whether there is something to be done here; else the picture is moved. */
  grips(bench: Bench, at: Point): boolean;
  /** What it would look like, in metres. */
  ghost(bench: Bench, from: Point, to: Point): Path2D | null;
  edit(bench: Bench, from: Point, to: Point): Edit | null;
}
