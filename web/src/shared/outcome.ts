import type { ColumnOffer, Outcome } from "../api/protocol";

/** A value of an outcome, as it is displayed. */
export interface Figure {
  /** The column of the value. */
  column: string;
  label: string;
  value: string;
  unit: string;
  /** The value in the unit of the column; null if it is no number. */
  number: number | null;
  group: string;
  help: string;
  isFirst: boolean;
}

/** The moment of an outcome. */
export interface Moment {
  isOver: boolean;
  time_s: number;
}

const units: [ending: string, unit: string][] = [
  ["_j", "J"],
  ["_s", "s"],
  ["_m", "m"],
];

/**
 * What is known of an outcome by now, in the order of the columns. What only the end or an event decides is left out until
 * then, or is "not yet" if it comes first.
 */
export function figuresOf(outcome: Outcome, columns: ColumnOffer[], moment: Moment): Figure[] {
  const isTrue = (column: string) => Number(outcome[column] ?? 0) > 0;
  return columns.flatMap((column) => {
    if (column.time_of !== null) return [];
    const time = isTrue(column.id) ? columns.find((each) => each.time_of === column.id) : undefined;
    const shown = time ?? column;
    const isKnown = shown.after.length === 0 || shown.after.some(isTrue);
    const known = isKnown ? valueOf(outcome, shown, moment) : null;
    const figure = known ?? (column.is_first ? worded(moment.isOver ? "none" : "not yet") : null);
    const { label, help } = shown;
    const place = { group: column.group, isFirst: column.is_first };
    return figure ? [{ column: shown.id, label, help, ...place, ...figure }] : [];
  });
}

/** Figures by group, in the order of the first of each. */
export function grouped(figures: Figure[]): [group: string, figures: Figure[]][] {
  const groups = new Map<string, Figure[]>();
  for (const figure of figures) groups.set(figure.group, [...(groups.get(figure.group) ?? []), figure]);
  return [...groups];
}

/** A figure in words, such as `Distance 140 m`. */
export function inWords({ label, value, unit }: Figure): string {
  return `${label} ${value} ${unit}`.trim();
}

/** A figure of two runs, and by how much the second run has more. */
export interface ComparedFigure {
  column: string;
  label: string;
  help: string;
  left: string;
  right: string;
  difference: string;
}

export interface Side {
  outcome: Outcome;
  columns: ColumnOffer[];
  moment: Moment;
}

/** What is known of two outcomes by now, side by side. */
export function comparedFigures(left: Side, right: Side): ComparedFigure[] {
  const [one, other] = [left, right].map(
    ({ outcome, columns, moment }) =>
      new Map(figuresOf(outcome, columns, moment).map((figure) => [figure.column, figure])),
  );
  const units = new Map([...left.columns, ...right.columns].map(({ id, unit }) => [id, unit]));
  const columns = new Set([...(one?.keys() ?? []), ...(other?.keys() ?? [])]);
  return [...columns].flatMap((column) => {
    const [a, b] = [one?.get(column), other?.get(column)];
    const named = a ?? b;
    if (!named) return [];
    const [from, to] = [a?.number ?? null, b?.number ?? null];
    const more = from === null || to === null || from === to ? null : to - from;
    const { value, unit } = more === null ? worded("") : numberOf(more, units.get(column) ?? "");
    const { label, help } = named;
    return [{ column, label, help, left: text(a), right: text(b), difference: `${value} ${unit}`.trim() }];
  });
}

function text(figure: Figure | undefined): string {
  return figure ? `${figure.value} ${figure.unit}`.trim() : "–";
}

type Value = Pick<Figure, "value" | "unit" | "number">;

function worded(value: string): Value {
  return { value, unit: "", number: null };
}

/** The value of a column; null if it is not known yet. */
function valueOf(outcome: Outcome, column: ColumnOffer, { isOver, time_s }: Moment): Value | null {
  if (column.known === "clock" && !isOver)
    return { value: time_s.toFixed(1), unit: "s so far", number: time_s };
  if (column.known !== "always" && !isOver) return null;
  const value = outcome[column.id];
  if (column.known === "reason" && !value) return null;
  if (typeof value === "boolean") return worded(value ? "yes" : isOver ? "no" : "not yet");
  if (typeof value !== "number") return null;
  const all = allOf(outcome, column);
  if (all !== null)
    return { value: `${readable(value)} / ${readable(all)}`, unit: column.unit, number: value };
  return numberOf(value, column.unit);
}

/** The number of all, of which a column counts some; null if it counts something else. */
function allOf(outcome: Outcome, { out_of, all }: ColumnOffer): number | null {
  const parts = out_of.map((column) => outcome[column]);
  const isWhole = parts.length > 0 && parts.every((part) => typeof part === "number");
  return isWhole ? parts.reduce((sum: number, part) => sum + Number(part), 0) : all;
}

function numberOf(value: number, unit: string): Value {
  if (unit === "%") return { value: readable(100 * value), unit, number: value };
  if (unit === "J" && Math.abs(value) >= 10_000)
    return { value: readable(value / 1000), unit: "kJ", number: value };
  return { value: readable(value), unit, number: value };
}

/** A number with at most two decimals, never -0. */
function readable(value: number): string {
  const digits = Number.isInteger(value) || Math.abs(value) >= 100 ? 0 : 2;
  return (value + 0).toLocaleString("en", { maximumFractionDigits: digits });
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
