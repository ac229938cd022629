import type { StudyResult } from "../../api/study";

/** A configuration of two studies. */
export interface ComparedResult {
  label: string;
  a: StudyResult | null;
  b: StudyResult | null;
}

/** The configurations of two studies, those with the same label side by side. */
export function resultsOf(a: StudyResult[], b: StudyResult[]): ComparedResult[] {
  const labels = [...new Set([...a, ...b].map(({ label }) => label))];
  const named = (all: StudyResult[], wanted: string) => all.find(({ label }) => label === wanted) ?? null;
  return labels.map((label) => ({ label, a: named(a, label), b: named(b, label) }));
}

/** What is known of a configuration: `best, 120 runs, 97.5% (95.1 to 99.0%)`. */
export function evidenceOf(result: StudyResult | null): string {
  if (!result) return "not compared";
  const { verdict, runs, met } = result;
  const percent = (share: number) => (100 * share).toFixed(1);
  const share = met ? `, ${percent(met[0])}% (${percent(met[1])} to ${percent(met[2])}%)` : "";
  return `${verdict}, ${runs.toLocaleString("en")} ${runs === 1 ? "run" : "runs"}${share}`;
}

/** Key numbers of two answers, those with the same name side by side. */
export function factsOf(a: [string, string][], b: [string, string][]): [string, string, string][] {
  const names = [...new Set([...a, ...b].map(([name]) => name))];
  const named = (all: [string, string][], wanted: string) =>
    all.find(([name]) => name === wanted)?.[1] ?? "–";
  return names.map((name) => [name, named(a, name), named(b, name)]);
}
