import type { SignalOffer } from "../../../api/protocol";
import type { Session } from "../session.svelte";
import { type Axis, linesOf, pointsOf } from "./lines";
import type { Content, Drawn } from "./chart";
import { available, described, outcome } from "./signals";

/** Signals of robots and controllers that the server samples for a page, at most. */
export const maxSampled = 16;

/** The signals that are drawn below the canvas. */
export class Charts {
  /** The ids of the signals, in the order in which they were added. */
  chosen = $state<string[]>([]);
  private readonly axes = $state<Record<string, Axis>>({});
  /** Everything that can be added now. */
  readonly available = $derived.by((): SignalOffer[] => {
    const { setting, state, selected } = this.session;
    return setting ? available(setting.offer, state, selected) : [];
  });
  readonly lines = $derived.by(() => {
    const { setting } = this.session;
    const offers = setting ? this.chosen.map((id) => described(id, setting.offer)) : [];
    return linesOf(offers, this.axes);
  });
  readonly drawn = $derived.by((): Drawn[] => {
    void this.session.seriesVersion;
    const { series, samples } = this.session;
    return this.lines.map((line) => ({ line, points: pointsOf(line.id, series.rows, samples) }));
  });

  constructor(private readonly session: Session) {}

  get content(): Content {
    const { setting, state } = this.session;
    return { lines: this.drawn, step_s: setting?.step_s ?? 1, now_s: state?.time_s ?? 0 };
  }

  /** The chosen signals that the server has to sample. */
  get sampled(): string[] {
    return this.chosen.filter((id) => !id.startsWith(outcome));
  }

  get isFull(): boolean {
    return this.sampled.length >= maxSampled;
  }

  has(ids: string[]): boolean {
    return ids.every((id) => this.chosen.includes(id));
  }

  /** Adds these signals, or removes them if all of them are drawn. */
  toggle(ids: string[]): void {
    const others = this.chosen.filter((id) => !ids.includes(id));
    this.choose(this.has(ids) ? others : [...others, ...ids]);
  }

  choose(ids: string[]): void {
    const sampled = ids.filter((id) => !id.startsWith(outcome)).slice(0, maxSampled);
    this.chosen = ids.filter((id) => id.startsWith(outcome) || sampled.includes(id));
    this.session.chart(this.sampled);
  }

  moveToOtherAxis(id: string): void {
    const axis = this.lines.find((line) => line.id === id)?.axis;
    this.axes[id] = axis === "left" ? "right" : "left";
  }
}
