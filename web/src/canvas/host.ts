import type { Choose, Json, Point, Setting, State, Shown as ShownData } from "../api/protocol";
import type { BelievedMap } from "../shared/believed_map";
import type { Link } from "../shared/link";
import type { Camera } from "./camera";
import type { Shown } from "./drawing";
import type { FrameQueue } from "./frame_queue";
import type { ToolId } from "./tools";

/** What the canvas needs of the page that shows it. It sets `camera` and `follows`, and reads the rest. */
export interface Host {
  readonly session: DrawnRun;
  readonly link: Pick<Link, "view">;
  readonly layers: Shown;
  readonly tool: ToolId;
  /** The kind of item that the item tool places. */
  readonly itemKind: string;
  /** Chooses a value, or takes it back, and opens the panel that shows the consequence. */
  choose(choose: Choose): void;
  /** The place that is marked; null for none. */
  readonly marked: Point | null;
  /** Whether the selected robot stays in the centre. */
  follows: boolean;
  camera: Camera | null;
}

/** The run that is drawn, and what a pointer on the canvas changes in it. */
export interface DrawnRun {
  readonly setting: Setting | null;
  readonly state: Pick<State, "is_playing" | "inspection" | "robot"> | null;
  readonly map: BelievedMap | null;
  readonly shown: ShownData | null;
  readonly selected: string | null;
  readonly frames: FrameQueue;
  /** Called when there is something new to draw. */
  onFrame: () => void;
  /** The latest frame has been drawn. */
  drew(): void;
  select(robot: string | null): void;
  change(path: string, value: Json): void;
}
