import type { Session } from "../session.svelte";
import { seconds } from "../../../shared/format";
import { type Entry, counted, entriesOf, filtered, neighbour } from "./events";

/** The events of a run, and which of them are shown. */
export class Timeline {
  search = $state("");
  /** Whether each kind is shown, by id; left out: as the server offers it. */
  private readonly chosen = $state<Record<string, boolean>>({});
  readonly entries = $derived.by(() => {
    const { events, setting } = this.session;
    return setting ? entriesOf(events, setting) : [];
  });
  /** The kinds that there are events of. */
  readonly kinds = $derived.by(() =>
    counted(this.entries, this.session.setting?.offer.events ?? []).map((kind) => ({
      ...kind,
      is_on: this.chosen[kind.id] ?? kind.is_on,
    })),
  );
  readonly shown = $derived.by(() => {
    const on = this.kinds.filter(({ is_on }) => is_on).map(({ id }) => id);
    return filtered(this.entries, new Set(on), this.search);
  });

  constructor(private readonly session: Session) {}

  show(kind: string, isOn: boolean): void {
    this.chosen[kind] = isOn;
  }

  time_s({ at }: Entry): number {
    return at * (this.session.setting?.step_s ?? 0);
  }

  describe(entry: Entry): string {
    return `${seconds(this.time_s(entry))}: ${entry.of} ${entry.text}`;
  }

  go({ at }: Entry): void {
    this.session.go(at);
  }

  /** Goes to the next or the previous event that is shown. */
  step(by: 1 | -1): void {
    const entry = neighbour(this.shown, this.session.tick, by);
    if (entry) this.go(entry);
  }
}
