/** What page and server say to each other; names and shapes are those of the server. */
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

export interface Fault {
  file: string | null;
  line: number | null;
  path: string;
  value: string | null;
  allowed: string;
  suggestion: string | null;
  message: string;
}

export interface Checked {
  name: string;
  engine: Engine;
  summary: string;
}

export interface RecordingEntry {
  id: string;
  bytes: number;
  /** When, in seconds since 1970. */
  saved_s: number;
  /** Null if `fault` says what is wrong with it. */
  of: {
    scenario: string;
    seed: string;
    run: string;
    program: string;
    /** Null if the file is cut. */
    steps: number | null;
    length_s: number | null;
  } | null;
  fault: string | null;
}

// From the page.

/** A configuration of a study. */
export interface OfStudy {
  id: string;
  configuration: number;
}

/** One of `scenario`, `text` and `study` says what runs. */
export interface Open {
  type: "open";
  scenario: string | null;
  text: string | null;
  study: OfStudy | null;
  recording: string | null;
  /** Decimal, as it can be up to 2^64 - 1; left out for that of the study; a recording has its own. */
  seed?: string;
  run: string;
  /** Null for those of the recording. */
  changes: Change[] | null;
  tick: number;
}

/** What frames are to come with. */
export interface Asked {
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
  | ({ type: "layers" } & Asked)
  | { type: "got"; frame: number };

// From the server.

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
  /** Where the run comes from, and the version that recorded it. */
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
  /** As all of a setting's places, in the unit of its world. */
  radius: number;
  flies: boolean;
  radio_range_m: number | null;
  sensors: SensorView[];
  /** The rays of its range sensors, in the order in which percepts have their scans. */
  rings: RingView[];
}

export interface ItemView {
  kind: string;
  at: Point;
  target: boolean;
  /** Outlines of where robots must be to find it, if there are such. */
  contact: Point[][];
}

export interface MapView {
  corners: [Point, Point, Point, Point];
  columns: number;
  rows: number;
  /** Base64 of a byte a cell; row 0 lies at the side from corner 0 to corner 1. */
  cells: string;
}

export interface WorldView {
  size: Point;
  periodic: boolean;
  unit: "m" | "px";
  /** How wide its cells are; null where there are none. */
  cell: number | null;
}

export interface Setting {
  type: "setting";
  generation: number;
  /** Time in the world that a step takes. */
  step_s: number;
  world: WorldView;
  document: Table;
  robots: string[];
  kinds: KindView[];
  items: ItemView[];
  /** In the order of the numbers that minds know them by. */
  item_kinds: string[];
  maps: MapView[];
  /** Those made by now. */
  changes: Change[];
  /** Those up to the edge; null if they are the recording's. */
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

export interface Course {
  bearing_rad: number;
  free_m: number;
  /** The place that it would get to, from the robot's front. */
  at: Point;
  utility: number;
}

export interface Reach {
  /** The next place on its way, from the robot's front. */
  to: Point;
  /** Which of the courses it took. */
  taken: number;
  courses: Course[];
}

export interface Thoughts {
  pose: Pose | null;
  items: BelievedItem[];
  robots: BelievedRobot[];
  goals: Goal[];
  reach: Reach | null;
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
  looks: { sensor: number; age_s: number }[];
  contacts: Contact[];
  neighbours: Neighbour[];
  inbox: { age_s: number; message: Said }[];
}

/** A message between robots: what it is about is its only key. */
export interface Said {
  about: { [about: string]: Json };
  confidence: number;
}

export interface Decided {
  motion: Motion;
  requests: { sensor: number; on: boolean }[];
  outbox: Said[];
}

/** What a robot perceived and decided in one step of its brain; null if it has not, but for `thoughts`. */
export interface Mind {
  robot: string;
  tick: number | null;
  percept: Percept | null;
  command: Decided | null;
  /** Place of the behaviour that has its way; null if none has, or all count together. */
  leading: number | null;
  holds_s: number[] | null;
  thoughts: Thoughts | null;
}

/** What a robot believes of its field: the cells of a rectangle, the others are as they were. */
export interface MapPart {
  type: "map";
  robot: string;
  corner: Point;
  cell_m: number;
  columns: number;
  rows: number;
  from: [column: number, row: number];
  size: [columns: number, rows: number];
  /** Base64 of a byte a cell, the lowest row first: 0 to 100 percent filled, 255 unknown. */
  occupancy: string;
  /** The same: 0 to 100 percent that an item there would not have been seen. */
  unseen: string;
}

/** What an engine tells of the selected robot, besides its mind. */
export interface RobotView {
  name: string;
  facts: [name: string, text: string][];
  /** Outlines of the cells that it would look at if it decided now. */
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
  /** Times real time that is reached. */
  real: number;
  /** The tick that it is on its way to; null if it stands or plays. */
  aim: number | null;
  over: boolean;
  /** The tick at which the run was found not to be as recorded. */
  differs_at: number | null;
  outcome: Outcome;
  mind: Mind | null;
  robot: RobotView | null;
}

export interface Refused {
  type: "refused";
  about: string;
  /** Of the change that was refused. */
  path: string | null;
  faults: Fault[];
}

/** How far a recording is. */
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
