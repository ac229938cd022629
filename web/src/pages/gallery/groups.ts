import type { ScenarioEntry } from "../../api/protocol";
import type { Row } from "../../shared/library/filter";

/** A scenario in the gallery. */
export type ScenarioRow = Row & { entry: ScenarioEntry };

export interface ScenarioGroup {
  title: string;
  rows: ScenarioRow[];
}

/** The groups of scenarios, in the order in which each group first occurs. */
export function groupsOf(rows: ScenarioRow[]): ScenarioGroup[] {
  const groups = new Map<string, ScenarioRow[]>();
  for (const row of rows) groups.set(row.entry.group, [...(groups.get(row.entry.group) ?? []), row]);
  return [...groups].map(([title, rows]) => ({ title, rows }));
}

/** Some of the rows, in the order of all. */
export function inOrderOf(all: ScenarioRow[], some: ScenarioRow[]): ScenarioRow[] {
  const shown = new Set(some);
  return all.filter((row) => shown.has(row));
}
