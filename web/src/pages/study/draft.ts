import type { Ask, Asked, Factor, Factors, Guarantee } from "../../api/study";
import type { Fault } from "../../api/protocol";

/** A study as it is being typed: texts, empty where the scenario's or the usual value holds. */
export interface Draft {
  /** Of all factors that are offered in the form; empty for those that are not varied. */
  vary: Record<string, string>;
  design: string;
  delta: string;
  confidence: string;
  guarantee: Guarantee;
  merit: string;
  runs: string;
  max_runs: string;
  seed: string;
}

/** What is wrong, in words, by field; all that belongs to none is under "". */
export type Wrongs = Record<string, string>;

const numbers = ["delta", "confidence", "runs", "max_runs"] as const;
const usualGuarantee: Guarantee = "indifference";
const teamPath = /^robots\.([^.]+)\.count$/;

/** What the scenario asks, with the sizes of all its teams to begin with. */
export function draftOf({ factors }: Factors): Draft {
  const offered = factors.filter(({ path, varied }) => varied !== null || teamPath.test(path));
  return {
    vary: Object.fromEntries(offered.map(({ path, varied }) => [path, varied ?? ""])),
    design: "",
    delta: "",
    confidence: "",
    guarantee: usualGuarantee,
    merit: "",
    runs: "",
    max_runs: "",
    seed: "0",
  };
}

/** What the server is asked, or what in the draft cannot be said to it. */
export function askOf(of: Asked, draft: Draft, factors: Factor[]): { ask: Ask } | { wrongs: Wrongs } {
  const wrongs: Wrongs = {};
  for (const name of numbers) {
    const text = draft[name].trim();
    if (text !== "" && !Number.isFinite(Number(text))) wrongs[name] = `"${text}" must be a number`;
  }
  if (Object.values(draft.vary).every((text) => text.trim() === ""))
    wrongs[""] = "Nothing is varied yet: give at least one range, such as 1..8.";
  if (Object.keys(wrongs).length > 0) return { wrongs };
  const [delta, confidence, runs, max_runs] = numbers.map((name) => numberOf(draft[name]));
  const ask = {
    ...of,
    vary: variedOf(draft, factors),
    design: draft.design.trim() || null,
    delta: delta ?? null,
    confidence: confidence ?? null,
    guarantee: draft.guarantee === usualGuarantee ? null : draft.guarantee,
    merit: draft.merit.trim() || null,
    runs: runs ?? null,
    max_runs: max_runs ?? null,
    seed: draft.seed.trim() || "0",
  };
  return { ask };
}

/** Faults under the fields of `draft` that they are about. */
export function wrongsOf(faults: Fault[], draft: Draft): Wrongs {
  const wrongs: Wrongs = {};
  for (const { path, message } of faults) {
    const field = fieldOf(path);
    const place = field in draft.vary || (field in draft && field !== "vary") ? field : "";
    wrongs[place] = [wrongs[place], message].filter(Boolean).join(" ");
  }
  return wrongs;
}

/** What holds for a factor now, in words. */
export function valueWords({ value }: Factor): string {
  return value === null ? "the model's own" : String(value);
}

/** The kind of robots whose number stands at a path; null if it is another path. */
export function teamOf(path: string): string | null {
  return teamPath.exec(path)?.[1] ?? null;
}

/** What may be given for a factor, in words. */
export function rangeWords({ low, high, whole, values }: Factor): string {
  if (values) return values.map(String).join(", ");
  const kind = whole ? "whole numbers" : "numbers";
  if (low !== null && high !== null) return `${kind} from ${read(low)} to ${read(high)}`;
  if (low !== null) return `${kind} from ${read(low)}`;
  return high === null ? kind : `${kind} up to ${read(high)}`;
}

function read(value: number): string {
  return value.toLocaleString("en", { maximumSignificantDigits: 6 });
}

function numberOf(text: string): number | null {
  return text.trim() === "" ? null : Number(text);
}

/** `study.vary."robots.rover.count"` is about `robots.rover.count`. */
function fieldOf(path: string): string {
  return path
    .replace(/^study\./, "")
    .replace(/^vary\./, "")
    .replaceAll('"', "");
}

/** All that is varied; nothing where it is just what the scenario varies itself. */
function variedOf({ vary }: Draft, factors: Factor[]): Record<string, string> {
  const own = factors.filter((factor) => factor.varied !== null);
  const given = Object.entries(vary).filter(([, text]) => text.trim() !== "");
  const isAsScenario =
    given.length === own.length && own.every(({ path, varied }) => vary[path]?.trim() === varied);
  return isAsScenario ? {} : Object.fromEntries(given.map(([path, text]) => [path, text.trim()]));
}
