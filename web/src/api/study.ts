/** Messages about studies: generated from the Rust types, but for the runs. */
import type { InputError, Json, StudyProgress } from "./protocol";

export type * from "./protocol";
export type { StudyQuestion as Question, StudyResult as Result } from "./protocol";

/** A scenario of the server by id, or the text of one: exactly one of the two. */
export type ScenarioSource = { scenario: string; text: null } | { scenario: null; text: string };

/** A Vega-Lite specification. */
export type Spec = Record<string, Json>;

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
