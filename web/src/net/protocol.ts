/** What page and server say to each other; names and shapes are those of the server. */
import type { Studying } from "./study";

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
  given: string | null;
  allowed: string;
  suggestion: string | null;
  message: string;
}

export interface Checked {
  name: string;
  engine: Engine;
  summary: string;
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
  /** Decimal, as it can be up to 2^64 - 1; left out for that of the study. */
  seed?: string;
  run: string;
  changes: Change[];
  tick: number;
}

export type Speed = number | null;

export type Command =
  | Open
  | { type: "play"; speed: Speed }
  | { type: "pause" }
  | { type: "step"; steps: number }
  | { type: "go"; tick: number }
  | { type: "change"; path: string; value: Json }
  | { type: "undo" }
  | { type: "select"; robot: string | null }
  | { type: "got"; frame: number };

// From the server.

export interface Opened {
  type: "opened";
  scenario: {
    id: string | null;
    name: string;
    engine: Engine;
    summary: string;
    cap_s: number;
    step_s: number;
  };
  seed: string;
  run: string;
}

export interface SensorView {
  name: string;
  kind: string;
  range_m: number;
  width_rad: number;
  facing_rad: number;
}

export interface KindView {
  name: string;
  count: number;
  radius_m: number;
  flies: boolean;
  radio_range_m: number | null;
  sensors: SensorView[];
}

export interface ItemView {
  kind: string;
  at_m: Point;
  sought: boolean;
}

export interface MapView {
  corners_m: [Point, Point, Point, Point];
  columns: number;
  rows: number;
  /** Base64 of a byte a cell; row 0 lies at the side from corner 0 to corner 1. */
  cells: string;
}

export interface Setting {
  type: "setting";
  generation: number;
  document: Table;
  robots: string[];
  kinds: KindView[];
  items: ItemView[];
  maps: MapView[];
  changes: Change[];
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
  verdict: "complete" | "impossible" | "approaching" | "receding";
}

export interface Mind {
  robot: string;
  pose: Pose | null;
  items: BelievedItem[];
  robots: BelievedRobot[];
  goals: Goal[];
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
  over: boolean;
  outcome: Outcome;
  mind: Mind | null;
}

export interface Refused {
  type: "refused";
  about: string;
  faults: Fault[];
}

export interface Ended {
  type: "ended";
  why: string;
  message: string;
}

export type Message = Opened | Setting | State | Refused | Ended | Studying;

const types = ["opened", "setting", "state", "refused", "ended", "studying"];

/** The message in a text from the server; null if it is none that this page knows. */
export function readMessage(text: string): Message | null {
  try {
    const message: unknown = JSON.parse(text);
    if (typeof message !== "object" || message === null || !("type" in message)) return null;
    return types.includes(String(message.type)) ? (message as Message) : null;
  } catch {
    return null;
  }
}
