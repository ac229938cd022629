import type { StudyState, StudyProgress } from "../../api/study";
import { plural } from "../../shared/format";

export const stateLabels: Record<StudyState, string> = {
  running: "Running",
  answered: "Answered",
  stopped: "Stopped",
  damaged: "Damaged",
};

/** The state of the race in one or two sentences, for screen readers. */
export function raceSummary(race: StudyProgress, total: number, labels: string[]): string {
  const known = race.certified === null ? remaining(race, total) : decided(race);
  const parts = [...known.map(([value, name]) => `${value} ${name}`), plural(race.runs, "run")];
  if (race.state === "running" && race.remaining_s !== null)
    parts.push(`about ${durations(race.remaining_s)} left`);
  const best = bestOf(race);
  const verb = race.certified === null ? "Leading" : "Cheapest certified";
  const leads = best === null ? "" : ` ${verb}: ${nameOf(labels, best)}.`;
  return `${stateLabels[race.state]}: ${parts.join(", ")}.${leads}`;
}

/** The configuration that would be selected now; null if there is none. */
export function bestOf({ certified, standings }: StudyProgress): number | null {
  const best =
    certified === null ? standings[0] : standings.find(([, , , , , status]) => status === "certified");
  return best?.[0] ?? null;
}

type Figure = [value: string, label: string];

function remaining(race: StudyProgress, total: number): Figure[] {
  return [[`${count(race.remaining)} of ${count(total)}`, "remaining"]];
}

function decided({ certified, eliminated }: StudyProgress): Figure[] {
  return [
    [count(certified ?? 0), "certified"],
    [count(eliminated.length), "eliminated"],
  ];
}

/** The key figures of a race, with labels. */
export function raceFigures(race: StudyProgress, total: number): Figure[] {
  const first: Figure[] = [
    ...(race.certified === null ? remaining(race, total) : decided(race)),
    [count(race.runs), "runs"],
    [count(race.rounds), "round"],
  ];
  if (race.state !== "running")
    return [...first, [race.seconds > 0 ? duration(race.seconds) : "–", "elapsed"]];
  const left: Figure[] =
    race.remaining_s === null ? [] : [[durations(race.remaining_s), "time left (estimate)"]];
  // Unknown if another process computes the runs.
  const rate = race.seconds > 0 ? count(race.runs_per_s) : "–";
  return [...first, [rate, "runs per second"], ...left];
}

export function nameOf(labels: string[], configuration: number): string {
  return labels[configuration] ?? `configuration ${configuration}`;
}

export function count(value: number): string {
  return value.toLocaleString("en", { maximumFractionDigits: 0 });
}

/** Such as `3 s`, `12 min` or `2 h 5 min`. */
export function duration(time_s: number): string {
  if (time_s < 99.5) return `${time_s > 0 ? Math.max(1, Math.round(time_s)) : 0} s`;
  const minutes = Math.round(time_s / 60);
  if (minutes < 100) return `${minutes} min`;
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/** A range of durations, such as `2 to 6 min`; one if both ends are the same. */
export function durations([low_s, high_s]: [number, number]): string {
  const [low, high] = [duration(low_s), duration(high_s)];
  if (low === high) return low;
  const [, number, unit] = /^(\d+) (\w+)$/.exec(low) ?? [];
  const isShared = unit !== undefined && new RegExp(`^\\d+ ${unit}$`).test(high);
  return `${isShared ? number : low} to ${high}`;
}

/** One for all calls: a list has hundreds. */
const relative = new Intl.RelativeTimeFormat("en", { numeric: "auto" });

/** Time since a change, such as `3 minutes ago`. */
export function ago(changed_s: number, now_s: number): string {
  const past = Math.max(0, now_s - changed_s);
  if (past < 60) return "just now";
  if (past < 3600) return relative.format(-Math.floor(past / 60), "minute");
  if (past < 86_400) return relative.format(-Math.floor(past / 3600), "hour");
  return relative.format(-Math.floor(past / 86_400), "day");
}

/** Decimal places of merits, so that `delta` has two significant digits. */
export function places(delta: number): number {
  return Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(delta))));
}

export function decimal(value: number | null, digits: number): string {
  return value === null ? "–" : value.toFixed(digits).replace("-", "−");
}

/** The text of a merit in a study with this delta; of a share of runs, never rounded to none or all, if it is null. */
export function meritText(value: number | null, delta: number | null): string {
  return textOf(value, delta, (share) => share);
}

/** The text of the lower bound of a merit or share, which may be rounded to none. */
export function lowText(value: number | null, delta: number | null): string {
  return textOf(value, delta, (share) => Math.max(share, 0.5));
}

/** The text of the upper bound of a merit or share, which may be rounded to all. */
export function highText(value: number | null, delta: number | null): string {
  return textOf(value, delta, (share) => Math.min(share, 0.5));
}

/** The text of a merit, or of a share with the decimals that `like` of it needs. */
function textOf(value: number | null, delta: number | null, like: (share: number) => number): string {
  if (delta !== null || value === null) return decimal(value, delta === null ? 0 : places(delta));
  return `${(100 * value).toFixed(sharePlaces(like(value)))}%`;
}

/** Decimal places of a percentage: one, or as many as a share needs not to be rounded to none or all. */
function sharePlaces(share: number): number {
  const rarer = Math.min(share, 1 - share);
  const vanishes = rarer > 1e-9 && [0, 100].includes(Number((100 * share).toFixed(1)));
  return vanishes ? -Math.floor(Math.log10(100 * rarer)) : 1;
}

export function percent(share: number): string {
  return `${Number((100 * share).toFixed(6))}%`;
}
