import type { State } from "../../api/protocol";

/** The outcome of a run up to a tick. */
export interface Row {
  tick: number;
  time_s: number;
  values: Record<string, number>;
}

/** The outcomes received so far, ordered by tick. */
export class Series {
  rows: Row[] = [];

  /** Adds the outcome of a state. Rows beyond its edge are removed: a change has discarded that future. */
  add(state: State): void {
    while ((this.rows.at(-1)?.tick ?? -1) > state.latest_tick) this.rows.pop();
    const row = { tick: state.tick, time_s: state.time_s, values: numbers(state.outcome) };
    const place = this.placeOf(state.tick);
    const replaced = this.rows[place]?.tick === state.tick ? 1 : 0;
    this.rows.splice(place, replaced, row);
  }

  /** Sets the step length of all rows, so that time is monotonic after a change of the clock. */
  setStep(step_s: number): void {
    this.rows = this.rows.map((row) => ({ ...row, time_s: row.tick * step_s }));
  }

  /** The names of all values, in the order of their first appearance. */
  names(): string[] {
    return [...new Set(this.rows.flatMap((row) => Object.keys(row.values)))];
  }

  /** CSV with a header line. */
  csv(): string {
    const names = this.names().filter((name) => name !== "time_s");
    const lines = this.rows.map((row) => [
      row.tick,
      row.time_s,
      ...names.map((name) => row.values[name] ?? ""),
    ]);
    return [["tick", "time_s", ...names], ...lines].map((line) => `${line.join(",")}\n`).join("");
  }

  private placeOf(tick: number): number {
    let [low, high] = [0, this.rows.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.rows[middle]?.tick ?? 0) < tick) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}

function numbers(outcome: State["outcome"]): Record<string, number> {
  return Object.fromEntries(
    Object.entries(outcome).filter((entry): entry is [string, number] => typeof entry[1] === "number"),
  );
}
