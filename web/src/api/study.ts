/** Messages about studies. Names and shapes are those of the server. */
import type { Engine, InputError, RequirementStatus, StudyProgress, StudyState } from "./protocol";

export type { RequirementStatus, StudyProgress, StudyState };

export type Value = number | string | boolean;
export type Guarantee = "indifference" | "pgs";

export interface Requirement {
  words: string;
  conditions: string[];
  probability: number;
  tolerance: number;
}

/** The best by merit, or the cheapest that meets a requirement. */
export type Question = "merit" | "requirement";

/** A scenario of the server by id, or the text of one: exactly one of the two. */
export type ScenarioSource = { scenario: string; text: null } | { scenario: null; text: string };

export interface Factor {
  path: string;
  /** Null if the scenario does not set it. */
  value: Value | null;
  low: number | null;
  high: number | null;
  kind: "whole" | "real" | "choice";
  /** The choices, if it is not a number. */
  values: Value[] | null;
  unit: string | null;
  help: string;
  /** The scenario's own range, such as `1..8`. */
  varied: string | null;
}

export interface Factors {
  name: string;
  engine: Engine;
  summary: string;
  factors: Factor[];
  design: string;
  merits: string[];
  merit: string;
  delta: number | null;
  confidence: number;
  /** That of the scenario; null without one. */
  requirement: Requirement | null;
  /** Columns that conditions can be about. */
  columns: string[];
  /** The quantity to be minimal in a study with a requirement. */
  minimize: string;
  /** Limits the combinations; null if all are compared. */
  where: string | null;
}

/** Parts that belong to the other question are null. */
export type StudyRequest = ScenarioSource & {
  question: Question;
  require: string[] | null;
  probability: number | null;
  tolerance: number | null;
  minimize: string | null;
  where: string | null;
  vary: Record<string, string>;
  design: string | null;
  delta: number | null;
  confidence: number | null;
  guarantee: Guarantee | null;
  merit: string | null;
  runs: number | null;
  max_runs: number | null;
  seed: string;
};

export interface StudyPlan {
  id: string;
  name: string;
  configurations: number;
  /** Labels of the first configurations. */
  labels: string[];
  words: string;
  /** Null with a requirement, as the guarantee. */
  delta: number | null;
  confidence: number;
  guarantee: Guarantee | null;
  /** Null without a requirement. */
  requirement: (Requirement & { minimize: string }) | null;
  merit: string;
  /** Each has either values or a range. */
  factors: { path: string; values: Value[]; range: [low: number, high: number] | null }[];
  /** State of the study that exists in this folder; null if there is none. */
  state: StudyState | null;
}

export interface StudySummary {
  id: string;
  name: string;
  engine: Engine;
  state: StudyState;
  words: string;
  configurations: number;
  runs: number;
  confidence: number;
  /** Null with a requirement. */
  delta: number | null;
  sentence: string | null;
  /** Whether the answer recommends a configuration without reservation; null without an answer. */
  is_recommended: boolean | null;
  message: string | null;
  changed_s: number;
}

export interface StudyTable {
  caption: string;
  head: string[];
  rows: string[][];
  /** The configuration of each row. */
  configurations: (number | null)[];
}

export interface StudySection {
  id: string;
  title: string;
  words: string[];
  charts: string[];
  /** The caption of each chart. */
  captions: Record<string, string>;
  tables: StudyTable[];
  folded: boolean;
}

/** A Vega-Lite specification. */
export type Spec = Record<string, unknown>;

export interface Result {
  configuration: number;
  label: string;
  runs: number;
  /** With a requirement, that of the selected configuration is `best`, and that of others its status. */
  verdict: "best" | "tied" | "not better" | "undecided" | "worse" | "impossible" | RequirementStatus;
}

export interface StudyAnswer {
  /** What to send, how it does, what is known of the others, and what is not distinguished. */
  verdict: [first: string, second: string, third: string, small: string];
  sentence: string;
  guarantee: string;
  facts: [value: string, words: string][];
  quarantined: string;
  sections: StudySection[];
  charts: Record<string, Spec>;
  results: Result[];
}

export interface Study extends StudySummary {
  planned: StudyPlan;
  source: { scenario: string | null };
  answer: StudyAnswer | null;
}

export type Cell = number | string | boolean | null;

export interface StudyRun {
  run: string;
  quantile?: number;
  [column: string]: Cell | undefined;
}

export interface StudyRuns {
  configuration: number;
  label: string;
  total: number;
  runs: StudyRun[];
}

export type Standing = StudyProgress["standings"][number];
export type Elimination = StudyProgress["eliminated"][number];

/** The server refused a request. */
export class RequestError extends Error {
  constructor(readonly errors: InputError[]) {
    super(errors.map((error) => error.message).join(" "));
  }
}
