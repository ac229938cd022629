import type { EventKind, EventRow, EventsAnswer, Setting, VersionView } from "../../../api/protocol";

/** An event in the list and on the time slider. */
export interface Entry extends EventRow {
  /** The tick at which its effect is displayed. */
  at: number;
}

/** The events of a run with those that have arrived. */
export function withArrived(events: EventRow[], { since, rows }: EventsAnswer): EventRow[] {
  const kept = since > (events.at(-1)?.tick ?? -1) ? events : events.filter(({ tick }) => tick < since);
  return [...kept, ...rows];
}

/** The versions from the first to the current one. */
export function ancestors({ versions, version }: Setting): VersionView[] {
  const byNumber = new Map(versions.map((each) => [each.number, each]));
  const found: VersionView[] = [];
  for (let each = byNumber.get(version); each; each = byNumber.get(each.parent ?? -1)) found.unshift(each);
  return found;
}

/** All events and changes, in order. */
export function entriesOf(events: EventRow[], setting: Setting): Entry[] {
  const changes = ancestors(setting)
    .filter(({ parent }) => parent !== null)
    .map(({ tick, path, value }) => ({ tick, at: tick, kind: "changed", of: path, text: value, agent: "" }));
  const others = events.map((event) => ({ ...event, at: event.tick + 1 }));
  return changes.length === 0 ? others : [...others, ...changes].sort((one, other) => one.at - other.at);
}

/** The entries of the kinds that are on and that contain the search string, whatever its case. */
export function filtered(entries: Entry[], kinds: ReadonlySet<string>, search: string): Entry[] {
  const wanted = search.trim().toLowerCase();
  const contains = ({ of, text, agent }: Entry) =>
    wanted === "" || `${of} ${text} ${agent}`.toLowerCase().includes(wanted);
  return entries.filter((entry) => kinds.has(entry.kind) && contains(entry));
}

/** The kinds that a run has events of, with their numbers. */
export function counted(entries: Entry[], kinds: EventKind[]): (EventKind & { count: number })[] {
  const counts = new Map<string, number>();
  for (const { kind } of entries) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  return kinds.flatMap((kind) => {
    const count = counts.get(kind.id) ?? 0;
    return count > 0 ? [{ ...kind, count }] : [];
  });
}

/** The nearest entry before or after a tick; undefined if there is none. */
export function neighbour(entries: Entry[], tick: number, step: 1 | -1): Entry | undefined {
  return step > 0 ? entries.find(({ at }) => at > tick) : entries.findLast(({ at }) => at < tick);
}

/** The number of entries up to a tick. */
export function countUntil(entries: Entry[], tick: number): number {
  let [low, high] = [0, entries.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((entries[middle]?.at ?? 0) <= tick) low = middle + 1;
    else high = middle;
  }
  return low;
}
