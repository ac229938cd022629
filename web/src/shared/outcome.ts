import type { Outcome } from "../api/protocol";

export interface OutcomeRow {
  /** The column of the value. */
  column: string;
  name: string;
  value: string;
  unit: string;
}

const units: [ending: string, unit: string][] = [
  ["_j", "J"],
  ["_s", "s"],
  ["_m", "m"],
];

/** Displayed first, in this order; the others follow in the server's order. */
const first = ["merit", "collisions", "energy_j"];

/**
 * The rows of an outcome: found out of all targets, then values with units. The run number and the times of
 * finds are left out.
 */
export function outcomeRows(outcome: Outcome, target: number): OutcomeRow[] {
  const { found, missed, run: _, ...rest } = outcome;
  const rows: OutcomeRow[] = [];
  if (typeof found === "number") {
    const all = typeof missed === "number" ? found + missed : target;
    rows.push({ column: "found", name: "found", value: `${found} / ${all}`, unit: "" });
  }
  const shown = withoutFindTimes(Object.keys(rest));
  const names = [
    ...first.filter((name) => shown.includes(name)),
    ...shown.filter((name) => !first.includes(name)),
  ];
  return [
    ...rows,
    ...names.flatMap((name) => reason(name, rest) ?? event(name, rest) ?? row(name, rest[name])),
  ];
}

/** The row of why a run is over, which columns such as ended_hopeless state; undefined for other columns. */
function reason(name: string, outcome: Partial<Outcome>): OutcomeRow[] | undefined {
  if (!name.startsWith("ended_")) return undefined;
  const words = named(name.slice("ended_".length)).words;
  return outcome[name] ? [{ column: name, name: "ended", value: words, unit: "" }] : [];
}

/**
 * The row of something that happens once, such as declared with its time declared_s: the time if it did; undefined for
 * other columns, and no row for the time itself.
 */
function event(name: string, outcome: Partial<Outcome>): OutcomeRow[] | undefined {
  const happened = name.endsWith("_s") ? name.slice(0, -2) : undefined;
  if (happened !== undefined && happened in outcome) return [];
  const time = outcome[`${name}_s`];
  if (time === undefined) return undefined;
  return outcome[name]
    ? row(`${name}_s`, time)
    : [{ column: name, name: named(name).words, value: "no", unit: "" }];
}

/**
 * Columns without the times of finds, found_KIND_1_s, found_KIND_2_s and so on: there may be one for each item.
 * Each kind of items has a column missed_KIND.
 */
export function withoutFindTimes(columns: string[]): string[] {
  const isFindTime = (column: string) => {
    const kind = /^found_(.+)_[0-9]+_s$/.exec(column)?.[1];
    return kind !== undefined && columns.includes(`missed_${kind}`);
  };
  return columns.filter((column) => !isFindTime(column));
}

/** The words and the unit of a column name. */
export function named(column: string): { words: string; unit: string } {
  const [ending = "", unit = ""] = units.find(([end]) => column.endsWith(end)) ?? [];
  return { words: column.slice(0, column.length - ending.length).replaceAll("_", " "), unit };
}

function row(name: string, value: Outcome[string] | undefined): OutcomeRow[] {
  if (name === "energy_j" && value === null)
    return [{ column: name, name: "energy", value: "not counted", unit: "" }];
  if (value === null || value === undefined || typeof value === "object") return [];
  const { words, unit } = named(name);
  if (typeof value !== "number") return [{ column: name, name: words, value: String(value), unit: "" }];
  const [number, power] = unit === "J" && Math.abs(value) >= 10_000 ? [value / 1000, "k"] : [value, ""];
  return [{ column: name, name: words, value: readable(number), unit: `${power}${unit}` }];
}

function readable(value: number): string {
  if (Number.isInteger(value)) return value.toLocaleString("en");
  return value.toLocaleString("en", { maximumFractionDigits: Math.abs(value) >= 100 ? 0 : 2 });
}
