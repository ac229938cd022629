import type { SignalOffer } from "../../../api/protocol";
import type { Row } from "../series";
import type { Points } from "./csv";
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

/** The labels of an axis with marks at a distance: two marks never have the same label. */
export function labelsOf(marks: number[], distance: number): string[] {
  const digits = Math.min(12, Math.max(0, Math.ceil(-Math.log10(distance) - 1e-9) + 1));
  return marks.map((mark) => mark.toLocaleString("en", { maximumFractionDigits: digits }));
}

/** The value of a line at a tick: its last one up to there; null if there is none. */
export function valueAt({ ticks, values }: Points, tick: number): number | null {
  const place = ticks.findLastIndex((each) => each <= tick);
  return place < 0 ? null : (values[place] ?? null);
}
