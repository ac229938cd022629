/** The messages between page and server, and what brains exchange: generated from the Rust types. */
import type { Json, Layers, State } from "./generated/page";

export type * from "./generated/brain";
export type * from "./generated/page";
export type { GoalState as Goal, Message as RobotMessage } from "./generated/brain";
export type {
  Checked as ScenarioSummary,
  LoggedChange as Change,
  Series as SeriesAnswer,
  StudyMember as StudyConfiguration,
} from "./generated/page";

export type Table = { [key: string]: Json };

/** What frames are sent with. */
export type OverlayRequest = Omit<Layers, "type">;

export type Speed = number | null;

export type Outcome = State["outcome"];

/** A value, and how old it is. */
export interface Reading<T> {
  value: T;
  age_s: number;
}
