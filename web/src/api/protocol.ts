/** The messages between page and server, and what brains exchange: generated from the Rust types. */
import type { Json, Show, State } from "./generated/page";

export type * from "./generated/brain";
export type * from "./generated/page";
export type { GoalState as Goal, Message as RobotMessage } from "./generated/brain";
export type {
  Checked as ScenarioSummary,
  LoggedChange as Change,
  Events as EventsAnswer,
  Series as SeriesAnswer,
  Signals as SignalsAnswer,
  StudyMember as StudyConfiguration,
  Table as TableData,
} from "./generated/page";

export type Table = { [key: string]: Json };

/** What is sent with frames. */
export type ShowRequest = Required<Omit<Show, "type">>;

export type Speed = number | null;

export type Outcome = State["outcome"];

/** A value, and how old it is. */
export interface Reading<T> {
  value: T;
  age_s: number;
}
