import type { Economy, Json, Lanes, Setting, State } from "../api/protocol";
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
  /** The controller that is chosen in the panel; null for none. */
  readonly controller: string | null;
  /** The controller whose belief of the mined lane is drawn; null for the first. */
  readonly laneController: string | null;
  /** Chooses a controller, which shows its goals. */
  chooseController(name: string): void;
  /** Whether the selected robot stays in the centre. */
  follows: boolean;
  camera: Camera | null;
}

/** The run that is drawn, and what a pointer on the canvas changes in it. */
export interface DrawnRun {
  readonly setting: Setting | null;
  readonly state: Pick<State, "is_playing" | "inspection" | "robot"> | null;
  readonly map: BelievedMap | null;
  readonly economy: Economy | null;
  readonly lanes: Lanes | null;
  readonly selected: string | null;
  readonly frames: FrameQueue;
  /** Called when there is something new to draw. */
  onFrame: () => void;
  /** The latest frame has been drawn. */
  drew(): void;
  select(robot: string | null): void;
  change(path: string, value: Json): void;
}
