/** Messages about runs. Names and shapes are those of the server. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type Table = { [key: string]: Json };
export type Point = [number, number];

/** From `tick` on, the value at `path` is `value`. */
export type Change = [tick: number, path: string, value: Json];

export type Engine = "metric" | "classic";

export interface ScenarioEntry {
  id: string;
  name: string;
  engine: Engine;
  summary: string;
  where: "shipped" | "folder";
}

export interface InputError {
  file: string | null;
  line: number | null;
  path: string;
  value: string | null;
  allowed: string;
  suggestion: string | null;
  message: string;
}

export interface ScenarioSummary {
  name: string;
  engine: Engine;
  summary: string;
}

export interface RecordingEntry {
  id: string;
  bytes: number;
  /** Time of saving, in seconds since 1970. */
  saved_s: number;
  /** Null if the file cannot be opened; `fault` gives the reason. */
  of: {
    scenario: string;
    seed: string;
    run: string;
    program: string;
    /** Null if the file is truncated. */
    steps: number | null;
    length_s: number | null;
  } | null;
  fault: string | null;
}

// Page to server.

/** A configuration of a study. */
export interface StudyConfiguration {
  id: string;
  configuration: number;
}

/** Exactly one of `scenario`, `text`, `study` and `recording` is given. */
export interface Open {
  type: "open";
  scenario: string | null;
  text: string | null;
  study: StudyConfiguration | null;
  recording: string | null;
  /** Decimal, 0 to 2^64 - 1. Left out for the study's own seed; ignored for a recording. */
  seed?: string;
  run: string;
  /** Null: the recording's changes. */
  changes: Change[] | null;
  tick: number;
}

/** The overlays that frames come with. */
export interface OverlayRequest {
  links: boolean;
  footprints: boolean;
}

export type Speed = number | null;

export type Command =
  | Open
  | { type: "play"; speed: Speed }
  | { type: "pause" }
  | { type: "step"; steps: number }
  | { type: "go"; tick: number }
  | { type: "change"; path: string; value: Json; instead: boolean }
  | { type: "undo" }
  | { type: "save" }
  | { type: "cancel" }
  | { type: "export" }
  | { type: "select"; robot: string | null }
  | ({ type: "layers" } & OverlayRequest)
  | { type: "got"; frame: number };

// Server to page.

export interface Opened {
  type: "opened";
  scenario: {
    id: string | null;
    name: string;
    engine: Engine;
    summary: string;
    time_limit_s: number;
  };
  seed: string;
  run: string;
  /** The recording that is replayed, and the version that made it. */
  recording: { id: string; program: string } | null;
}

export interface SensorView {
  name: string;
  kind: string;
  range_m: number;
  width_rad: number;
  facing_rad: number;
}

export interface RingView {
  bearings_rad: number[];
  range_m: number;
}

export interface KindView {
  name: string;
  count: number;
  /** In the unit of the world, as all lengths of a setting. */
  radius: number;
  flies: boolean;
  radio_range_m: number | null;
  sensors: SensorView[];
  /** Rays of the range sensors, in the order of the scans in percepts. */
  rings: RingView[];
}

export interface ItemView {
  kind: string;
  at: Point;
  target: boolean;
  /** Outlines of the areas in which robots find it, where the engine has them. */
  contact: Point[][];
}

export interface MapView {
  corners: [Point, Point, Point, Point];
  columns: number;
  rows: number;
  /** Base64, one byte per cell; row 0 is the edge from corner 0 to corner 1. */
  cells: string;
}

export interface WorldView {
  size: Point;
  periodic: boolean;
  unit: "m" | "px";
  /** Cell width; null for a world without cells. */
  cell: number | null;
}

export interface Setting {
  type: "setting";
  generation: number;
  /** Simulated time per step. */
  step_s: number;
  world: WorldView;
  document: Table;
  robots: string[];
  kinds: KindView[];
  items: ItemView[];
  /** In the order of the kind numbers in beliefs. */
  item_kinds: string[];
  maps: MapView[];
  /** Changes up to the current tick. */
  changes: Change[];
  /** Changes up to the last computed tick; null: the recording's changes. */
  log: Change[] | null;
}

export interface Pose {
  at: Point;
  heading_rad: number;
  deviation_m: number;
  deviation_rad: number;
  age_s: number;
}

export interface BelievedItem {
  kind: number;
  at: Point;
  deviation_m: number;
  confidence: number;
}

export interface BelievedRobot {
  id: { kind: number; number: number } | [number, number] | null;
  at: Point;
  velocity_m_s: Point;
  age_s: number;
}

export interface Goal {
  behaviour: number;
  to: Point;
  precedence: number;
  value: number;
  likely: number;
  time_s: number;
  within_m: number;
  verdict: "complete" | "impossible" | "approaching" | "receding";
  left_m: number;
  best_m: number;
  stuck_s: number;
  rests_s: number;
  is_pursued: boolean;
}

export interface HeadingOption {
  bearing_rad: number;
  free_m: number;
  /** The point that it leads to, in the robot's frame. */
  at: Point;
  utility: number;
}

export interface HeadingOptions {
  /** The next waypoint, in the robot's frame. */
  to: Point;
  /** Index of the chosen option. */
  taken: number;
  courses: HeadingOption[];
}

export interface BeliefState {
  pose: Pose | null;
  items: BelievedItem[];
  robots: BelievedRobot[];
  goals: Goal[];
  reach: HeadingOptions | null;
}

export interface Reading<T> {
  value: T;
  age_s: number;
}

export interface Motion {
  speed_m_s: number;
  turn_rate_rad_s: number;
}

export interface Contact {
  kind: number;
  range_m: number;
  bearing_rad: number;
  age_s: number;
}

export interface Neighbour {
  range_m: number;
  bearing_rad: number;
  course_rad: number | null;
  age_s: number;
  id: { kind: number; index: number };
}

export interface Percept {
  time_s: number;
  position: Reading<Point> | null;
  heading_rad: Reading<number> | null;
  motion: Reading<Motion> | null;
  battery: Reading<number> | null;
  touch: Reading<boolean> | null;
  scans: { age_s: number | null; ranges_m: (number | null)[] }[];
  observations: { sensor: number; age_s: number }[];
  contacts: Contact[];
  neighbours: Neighbour[];
  inbox: { age_s: number; message: RobotMessage }[];
}

/** A message between robots; the only key of `about` is its subject. */
export interface RobotMessage {
  about: { [about: string]: Json };
  confidence: number;
}

export interface RobotCommand {
  motion: Motion;
  requests: { sensor: number; on: boolean }[];
  outbox: RobotMessage[];
}

/** One step of a robot's brain. Fields other than the beliefs are null before its first step. */
export interface Inspection {
  robot: string;
  tick: number | null;
  percept: Percept | null;
  command: RobotCommand | null;
  /** Index of the active behaviour; null if none is active, or if the output blends all. */
  leading: number | null;
  holds_s: number[] | null;
  thoughts: BeliefState | null;
}

/** A rectangle of a robot's believed map; other cells are unchanged. */
export interface MapPart {
  type: "map";
  robot: string;
  corner: Point;
  cell_m: number;
  columns: number;
  rows: number;
  from: [column: number, row: number];
  size: [columns: number, rows: number];
  /** Base64, one byte per cell, bottom row first: 0 to 100 percent occupied, 255 unknown. */
  occupancy: string;
  /** As `occupancy`: probability in percent that an item in the cell was not detected. */
  unseen: string;
}

/** What the engine reports about the selected robot besides the inspection. */
export interface RobotView {
  name: string;
  facts: [name: string, text: string][];
  /** Outlines of the cells that its next decision would observe. */
  looks: Point[][];
}

export type Outcome = Record<string, number | string | boolean | null>;

export interface State {
  type: "state";
  tick: number;
  edge: number;
  time_s: number;
  hash: string;
  playing: boolean;
  speed: Speed;
  /** Actual speed, in multiples of real time. */
  real: number;
  /** The tick that the run is computing towards; null if it is paused or playing. */
  aim: number | null;
  over: boolean;
  /** The first tick at which the run differs from the recording. */
  differs_at: number | null;
  outcome: Outcome;
  mind: Inspection | null;
  robot: RobotView | null;
}

export interface Refused {
  type: "refused";
  about: string;
  /** Path of the refused change. */
  path: string | null;
  faults: InputError[];
}

/** Progress of saving a recording. */
export interface Saving {
  type: "saving";
  done: number;
  steps: number;
}

export interface Saved {
  type: "saved";
  /** Null if it was cancelled. */
  recording: RecordingEntry | null;
}

export interface Exported {
  type: "exported";
  text: string;
}

export interface Ended {
  type: "ended";
  why: string;
  message: string;
}
