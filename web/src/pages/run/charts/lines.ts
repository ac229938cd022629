import type { SignalOffer } from "../../../api/protocol";
import type { Row } from "../series";
import type { Samples } from "./samples";
import { outcome } from "./signals";

export type Axis = "left" | "right";

/** A signal in a chart. */
export interface Line extends SignalOffer {
  axis: Axis;
  /** A name of a colour of the theme. */
  colour: string;
  isDashed: boolean;
}

/** The points of a line: a value is null where there is none. */
export interface Points {
  ticks: number[];
  values: (number | null)[];
}

const colours = ["owner-1", "owner-2", "owner-3", "owner-4", "owner-5", "owner-6"];

/** The lines of signals: the first unit has the left axis, all others the right one, unless it is chosen. */
export function linesOf(signals: SignalOffer[], axes: Record<string, Axis>): Line[] {
  return signals.map((signal, i) => ({
    ...signal,
    axis: axes[signal.id] ?? (signal.unit === signals[0]?.unit ? "left" : "right"),
    colour: colours[i % colours.length] ?? "text",
    isDashed: i >= colours.length,
  }));
}

/** The points of a signal, from the outcome over time or from samples of the run. */
export function pointsOf(signal: string, series: Row[], samples: Samples): Points {
  if (signal.startsWith(outcome)) {
    const column = signal.slice(outcome.length);
    return {
      ticks: series.map(({ tick }) => tick),
      values: series.map(({ values }) => values[column] ?? null),
    };
  }
  const place = samples.signals.indexOf(signal);
  if (place < 0) return { ticks: [], values: [] };
  return {
    ticks: samples.rows.map(({ tick }) => tick),
    values: samples.rows.map(({ values }) => values[place] ?? null),
  };
}

/** The value of a line at a tick: its last one up to there; null if there is none. */
export function valueAt({ ticks, values }: Points, tick: number): number | null {
  const place = ticks.findLastIndex((each) => each <= tick);
  return place < 0 ? null : (values[place] ?? null);
}

/** CSV of exactly these points, with a row for each tick at which a line has one. */
export function csv(lines: { id: string; points: Points }[], step_s: number): string {
  const columns = lines.map(({ points }) => new Map(points.ticks.map((tick, i) => [tick, points.values[i]])));
  const ticks = [...new Set(lines.flatMap(({ points }) => points.ticks))].sort((one, other) => one - other);
  const rows = ticks.map((tick) => [
    tick,
    Number((tick * step_s).toPrecision(12)),
    ...columns.map((column) => column.get(tick) ?? ""),
  ]);
  const header = ["tick", "time_s", ...lines.map(({ id }) => quoted(id))];
  return [header, ...rows].map((row) => `${row.join(",")}\n`).join("");
}

function quoted(name: string): string {
  return /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
}
