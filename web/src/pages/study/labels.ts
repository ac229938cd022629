import type { StudyState, StudyProgress } from "../../api/study";
import { plural } from "../../shared/format";

export const stateLabels: Record<StudyState, string> = {
  running: "Running",
  answered: "Answered",
  stopped: "Stopped",
  damaged: "Damaged",
};

/** The state of the race in one sentence, for screen readers. */
export function raceSummary(race: StudyProgress, total: number, labels: string[]): string {
  const parts = [`${plural(race.remaining, "configuration")} of ${count(total)} remaining`];
  parts.push(plural(race.runs, "run"));
  if (race.remaining_s !== null) parts.push(`about ${duration(race.remaining_s)} left`);
  const [best] = race.standings;
  const leads = best ? ` Leading: ${nameOf(labels, best[0])}.` : "";
  return `${stateLabels[race.state]}: ${parts.join(", ")}.${leads}`;
}

/** The key figures of a race, with labels. */
export function raceFigures(race: StudyProgress, total: number): [value: string, label: string][] {
  const first: [string, string][] = [
    [`${count(race.remaining)} of ${count(total)}`, "remaining"],
    [count(race.runs), "runs"],
    [count(race.rounds), "round"],
  ];
  if (race.state !== "running")
    return [...first, [race.seconds > 0 ? duration(race.seconds) : "–", "elapsed"]];
  const left = race.remaining_s === null ? "–" : duration(race.remaining_s);
  // Unknown if another process computes the runs.
  const rate = race.seconds > 0 ? count(race.runs_per_s) : "–";
  return [...first, [rate, "runs per second"], [left, "time left (estimate)"]];
}

export function nameOf(labels: string[], configuration: number): string {
  return labels[configuration] ?? `configuration ${configuration}`;
}

export function count(value: number): string {
  return value.toLocaleString("en", { maximumFractionDigits: 0 });
}

/** Such as `3 s`, `12 min` or `2 h 5 min`. */
export function duration(time_s: number): string {
  if (time_s < 99.5) return `${Math.max(1, Math.round(time_s))} s`;
  const minutes = Math.round(time_s / 60);
  if (minutes < 100) return `${minutes} min`;
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/** Time since a change, such as `3 minutes ago`. */
export function ago(changed_s: number, now_s: number): string {
  const format = new Intl.RelativeTimeFormat("en", { numeric: "auto" });
  const past = Math.max(0, now_s - changed_s);
  if (past < 60) return "just now";
  if (past < 3600) return format.format(-Math.floor(past / 60), "minute");
  if (past < 86_400) return format.format(-Math.floor(past / 3600), "hour");
  return format.format(-Math.floor(past / 86_400), "day");
}

/** Decimal places of merits, so that `delta` has two significant digits. */
export function places(delta: number): number {
  return Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(delta))));
}

export function decimal(value: number | null, digits: number): string {
  return value === null ? "–" : value.toFixed(digits).replace("-", "−");
}

export function percent(share: number): string {
  return `${Number((100 * share).toFixed(6))}%`;
}

/** The message of an error, for display. */
export function errorText(error: unknown): string {
  // Without a server, `fetch` throws a TypeError with a message of the browser's.
  if (error instanceof TypeError || !(error instanceof Error)) return "The server is not responding.";
  return error.message;
}
