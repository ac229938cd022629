import type { SeriesRow, SignalsAnswer } from "../../../api/protocol";

/** Signals that the server has sampled from the run. */
export interface Samples {
  signals: string[];
  /** Ticks from one sample to the next. */
  every: number;
  /** The tick up to which the run was sampled. */
  until: number;
  rows: SeriesRow[];
}

export const noSamples: Samples = { signals: [], every: 1, until: -1, rows: [] };

/** The samples with those that have arrived. */
export function withSamples(
  samples: Samples,
  { signals, every, since, until, rows }: SignalsAnswer,
): Samples {
  const isSame = signals.join("\n") === samples.signals.join("\n");
  const kept = isSame ? samples.rows.filter(({ tick }) => tick < since) : [];
  return { signals, every, until, rows: [...kept, ...rows] };
}
