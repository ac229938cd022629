import type { SeriesAnswer, State } from "../../api/protocol";
import { csv } from "./charts/csv";

/** The outcome of a run up to a tick. */
export interface Row {
  tick: number;
  time_s: number;
  values: Record<string, number>;
}

/** The outcomes that the server has kept, ordered by tick, and the present one. */
export class Series {
  private kept: Row[] = [];
  private present: Row | null = null;
  private step_s = 0;
  /** Rows from this tick on are not known. */
  private missing = 0;

  /** The first tick to request of the server. */
  get since(): number {
    return Math.min(this.missing, this.kept.at(-1)?.tick ?? 0);
  }

  /** All rows. The present one is among them unless the run was moved back. */
  get rows(): Row[] {
    const { present } = this;
    return present && present.tick > (this.kept.at(-1)?.tick ?? -1) ? [...this.kept, present] : this.kept;
  }

  /** Adds rows of the server; returns whether they were still needed. */
  add({ since, columns, rows }: SeriesAnswer): boolean {
    if (since > this.since) return false;
    this.kept = this.kept.filter((row) => row.tick < since);
    for (const { tick, values } of rows) this.kept.push(this.row(tick, named(columns, values)));
    this.missing = Number.POSITIVE_INFINITY;
    return true;
  }

  /** Sets the present. Rows beyond the latest tick are removed: a change has discarded that future. */
  setPresent(state: State): void {
    this.kept = this.kept.filter((row) => row.tick <= state.latest_tick);
    this.present = { tick: state.tick, time_s: state.time_s, values: numbers(state.outcome) };
  }

  /** Sets the step length of all rows; all are requested again, because the run may be another one. */
  renew(step_s: number): void {
    this.step_s = step_s;
    this.missing = 0;
    this.kept = this.kept.map((row) => this.row(row.tick, row.values));
    if (this.present) this.present = this.row(this.present.tick, this.present.values);
  }

  /** The names of all values, in the order of their first appearance. */
  names(): string[] {
    return [...new Set(this.rows.flatMap((row) => Object.keys(row.values)))];
  }

  /** CSV with a header line. */
  csv(): string {
    const { rows } = this;
    const ticks = rows.map(({ tick }) => tick);
    const names = this.names().filter((name) => name !== "time_s");
    const line = (id: string) => ({
      id,
      points: { ticks, values: rows.map(({ values }) => values[id] ?? null) },
    });
    return csv(names.map(line), this.step_s);
  }

  private row(tick: number, values: Row["values"]): Row {
    return { tick, time_s: Number((tick * this.step_s).toPrecision(12)), values };
  }
}

function named(columns: string[], values: (number | null)[]): Row["values"] {
  const pairs = columns.map((column, i) => [column, values[i]] as const);
  return Object.fromEntries(pairs.filter((pair): pair is [string, number] => typeof pair[1] === "number"));
}

function numbers(outcome: State["outcome"]): Row["values"] {
  return Object.fromEntries(
    Object.entries(outcome).filter((entry): entry is [string, number] => typeof entry[1] === "number"),
  );
}
