/** What page and server say to each other of studies; names and shapes are those of the server. */
import type { Engine, Fault } from "./protocol";

export type StudyState = "running" | "answered" | "stopped" | "damaged";
export type Value = number | string | boolean;
export type Guarantee = "indifference" | "pgs";

/** A scenario of the server's by its id, or the text of one: exactly one of them. */
export type Asked = { scenario: string; text: null } | { scenario: null; text: string };

export interface Factor {
  path: string;
  /** Null if the scenario does not say. */
  value: Value | null;
  low: number | null;
  high: number | null;
  whole: boolean;
  /** What there is to choose from, if it is no number. */
  values: Value[] | null;
  /** How the scenario varies it itself, such as `1..8`. */
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
}

export type Ask = Asked & {
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

export interface Planned {
  id: string;
  name: string;
  configurations: number;
  /** Of the first configurations. */
  labels: string[];
  words: string;
  delta: number;
  confidence: number;
  guarantee: Guarantee;
  merit: string;
  /** Of each either values or a range. */
  factors: { path: string; values: Value[]; range: [low: number, high: number] | null }[];
  /** Of the study that is in this folder already. */
  state: StudyState | null;
}

export interface Listed {
  id: string;
  name: string;
  engine: Engine;
  state: StudyState;
  words: string;
  configurations: number;
  runs: number;
  confidence: number;
  delta: number;
  sentence: string | null;
  message: string | null;
  changed_s: number;
}

export type Interval = [value: number | null, low: number | null, high: number | null];

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
  /** What each chart shows, in words. */
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
  merit: Interval;
  verdict: "best" | "tied" | "no better" | "undecided" | "worse";
  eliminated: boolean;
}

export interface StudyAnswer {
  sentence: string;
  guarantee: string;
  facts: [value: string, words: string][];
  quarantined: string;
  sections: StudySection[];
  charts: Record<string, Spec>;
  results: Result[];
}

export interface Study extends Listed {
  planned: Planned;
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

export type Standing = [
  configuration: number,
  runs: number,
  value: number | null,
  low: number | null,
  high: number | null,
];
export type Elimination = [configuration: number, by: number, runs: number];

/** How a study stands; comes at most five times a second. */
export interface Studying {
  type: "studying";
  state: StudyState;
  message: string | null;
  round: number;
  runs: number;
  computed: number;
  seconds: number;
  runs_per_s: number;
  survivors: number;
  left_runs: number | null;
  left_s: number | null;
  /** Those still in, best first, 50 at most. */
  standings: Standing[];
  /** All so far, in their order. */
  eliminated: Elimination[];
  /** Of all configurations; in the first message only. */
  labels: string[] | null;
}

/** Why the server did not do what it was asked. */
export class Refusal extends Error {
  constructor(readonly faults: Fault[]) {
    super(faults.map((fault) => fault.message).join(" "));
  }
}
