import type { Factor, Factors, Guarantee, Question, ScenarioSource, StudyRequest } from "../../api/study";
import type { InputError } from "../../api/protocol";

/** The text fields of the study form; empty fields use the scenario's value or the default. */
export interface Draft {
  /** By path, for all factors in the form; empty: not varied. */
  vary: Record<string, string>;
  question: Question;
  /** One condition per line. */
  require: string;
  probability: string;
  tolerance: string;
  minimize: string;
  where: string;
  design: string;
  delta: string;
  confidence: string;
  guarantee: Guarantee;
  merit: string;
  runs: string;
  max_runs: string;
  seed: string;
}

/** Error messages by field; general ones under "". */
export type FieldErrors = Record<string, string>;

const numbers = ["delta", "confidence", "runs", "max_runs", "probability", "tolerance"] as const;
const defaultGuarantee: Guarantee = "indifference";
const teamPath = /^(?:robots|controllers)\.([^.]+)\.count$/;

/** A draft with the scenario's own factors and the counts of all kinds of robots and controllers. */
export function draftOf({ factors, requirement }: Factors): Draft {
  const offered = factors.filter(({ path, varied }) => varied !== null || teamPath.test(path));
  return {
    vary: Object.fromEntries(offered.map(({ path, varied }) => [path, varied ?? ""])),
    question: requirement === null ? "merit" : "requirement",
    require: "",
    probability: "",
    tolerance: "",
    minimize: "",
    where: "",
    design: "",
    delta: "",
    confidence: "",
    guarantee: defaultGuarantee,
    merit: "",
    runs: "",
    max_runs: "",
    seed: "0",
  };
}

/** The request for a draft, or the errors that prevent it. */
export function requestOf(
  source: ScenarioSource,
  draft: Draft,
  factors: Factor[],
): { request: StudyRequest } | { errors: FieldErrors } {
  const errors: FieldErrors = {};
  for (const name of numbers) {
    const text = draft[name].trim();
    if (text !== "" && !Number.isFinite(Number(text))) errors[name] = `"${text}" must be a number`;
  }
  if (Object.values(draft.vary).every((text) => text.trim() === ""))
    errors[""] = "No factor is varied: enter at least one range, such as 1..8.";
  if (Object.keys(errors).length > 0) return { errors };
  const request = {
    ...source,
    ...(draft.question === "merit" ? meritOf(draft) : requirementOf(draft)),
    vary: variedOf(draft, factors),
    where: draft.where.trim() || null,
    design: draft.design.trim() || null,
    confidence: numberOf(draft.confidence),
    max_runs: numberOf(draft.max_runs),
    seed: draft.seed.trim() || "0",
  };
  return { request };
}

/** What only a study of the best by merit has. */
function meritOf(draft: Draft) {
  return {
    question: "merit" as const,
    delta: numberOf(draft.delta),
    guarantee: draft.guarantee === defaultGuarantee ? null : draft.guarantee,
    merit: draft.merit.trim() || null,
    runs: numberOf(draft.runs),
    require: null,
    probability: null,
    tolerance: null,
    minimize: null,
  };
}

/** What only a study of a requirement has. */
function requirementOf(draft: Draft) {
  const conditions = draft.require.split("\n").map((line) => line.trim());
  const require = conditions.filter((line) => line !== "");
  return {
    question: "requirement" as const,
    require: require.length > 0 ? require : null,
    probability: numberOf(draft.probability),
    tolerance: numberOf(draft.tolerance),
    minimize: draft.minimize.trim() || null,
    delta: null,
    guarantee: null,
    merit: null,
    runs: null,
  };
}

/** The messages of input errors, by the field of `draft` that they refer to. */
export function fieldErrors(inputErrors: InputError[], draft: Draft): FieldErrors {
  const errors: FieldErrors = {};
  for (const { path, message } of inputErrors) {
    const field = fieldOf(path);
    const place = field in draft.vary || (field in draft && field !== "vary") ? field : "";
    errors[place] = [errors[place], message].filter(Boolean).join(" ");
  }
  return errors;
}

/** The current value of a factor. */
export function valueText({ value }: Factor): string {
  return value === null ? "model default" : String(value);
}

/** The current and the allowed values of a factor, with its unit. */
export function valuesText(factor: Factor): string {
  const unit = factor.unit === null ? "" : ` ${factor.unit}`;
  const value = factor.value === null ? valueText(factor) : valueText(factor) + unit;
  return `Current value ${value}; ${rangeText(factor)}${factor.values ? "" : unit}`;
}

/** Whether a factor is found by all of some words in lower case. */
export function isFoundBy({ path, help }: Factor, words: string[]): boolean {
  const text = `${path} ${help}`.toLowerCase();
  return words.every((word) => text.includes(word));
}

/** The kind of robots or controllers whose count is at a path; null for other paths. */
export function teamOf(path: string): string | null {
  return teamPath.exec(path)?.[1] ?? null;
}

/** The allowed values of a factor. */
export function rangeText({ low, high, kind: type, values }: Factor): string {
  if (values) return values.map(String).join(", ");
  const kind = type === "whole" ? "whole numbers" : "numbers";
  if (low !== null && high !== null) return `${kind} from ${numberText(low)} to ${numberText(high)}`;
  if (low !== null) return `${kind} from ${numberText(low)}`;
  return high === null ? kind : `${kind} up to ${numberText(high)}`;
}

function numberText(value: number): string {
  return value.toLocaleString("en", { maximumSignificantDigits: 6 });
}

function numberOf(text: string): number | null {
  return text.trim() === "" ? null : Number(text);
}

/** `study.vary."robots.rover.count"` refers to `robots.rover.count`, and `require.all[0]` to `require`. */
function fieldOf(path: string): string {
  return path
    .replace(/^study\./, "")
    .replace(/^vary\./, "")
    .replace(/^require\.all.*$/, "require")
    .replace(/^require\./, "")
    .replaceAll('"', "");
}

/** The varied factors; empty if they are exactly those that the scenario varies. */
function variedOf({ vary }: Draft, factors: Factor[]): Record<string, string> {
  const own = factors.filter((factor) => factor.varied !== null);
  const given = Object.entries(vary).filter(([, text]) => text.trim() !== "");
  const isAsScenario =
    given.length === own.length && own.every(({ path, varied }) => vary[path]?.trim() === varied);
  return isAsScenario ? {} : Object.fromEntries(given.map(([path, text]) => [path, text.trim()]));
}
