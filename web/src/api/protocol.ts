/** The messages between page and server, and what brains exchange: generated from the Rust types. */
import type { Json, Layers, State } from "./generated/page";

export type {
  BeliefState,
  BelievedItem,
  BelievedRobot,
  Command as RobotCommand,
  Contact,
  GoalState as Goal,
  HeadingOption,
  HeadingOptions,
  Message as RobotMessage,
  Motion,
  Neighbour,
  Percept,
  Point,
  Pose,
} from "./generated/brain";
export type {
  ControllerView,
  Economy,
  GoalStatus,
  GoalView,
  ServedGoalView,
  Checked as ScenarioSummary,
  Ended,
  Engine,
  Exported,
  Factor,
  FactorValue,
  Factors,
  Guarantee,
  InputError,
  Inspection,
  ItemView,
  Json,
  KindView,
  Lanes,
  LaneScale,
  LaneView,
  LoggedChange as Change,
  MapPart,
  MapView,
  MarkView,
  ObstacleView,
  Opened,
  PageMessage,
  RecordingEntry,
  Refused,
  RequirementStatus,
  RingView,
  RobotView,
  Saved,
  Saving,
  ScenarioEntry,
  SensorView,
  Series as SeriesAnswer,
  ServerMessage,
  Setting,
  State,
  Study,
  StudyAnswer,
  StudyList,
  StudyMember as StudyConfiguration,
  StudyPlan,
  StudyProgress,
  StudyQuestion,
  StudyRequest,
  StudyResult,
  StudySection,
  StudyState,
  StudySummary,
  StudyTable,
  WorldView,
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
