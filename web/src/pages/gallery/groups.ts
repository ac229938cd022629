import type { ScenarioEntry } from "../../api/protocol";

export interface ScenarioGroup {
  title: string;
  entries: ScenarioEntry[];
}

/** The groups of entries, in the order in which each group first occurs. */
export function groupsOf(entries: ScenarioEntry[]): ScenarioGroup[] {
  const groups = new Map<string, ScenarioEntry[]>();
  for (const entry of entries) groups.set(entry.group, [...(groups.get(entry.group) ?? []), entry]);
  return [...groups].map(([title, entries]) => ({ title, entries }));
}
