import type { StudyState, Studying } from "../../api/study";
import { plural } from "../../shared/format";

export const stateWords: Record<StudyState, string> = {
  running: "Running",
  answered: "Answered",
  stopped: "Stopped",
  damaged: "Damaged",
};

/** What the picture of the race says. */
export function raceWords(race: Studying, total: number, labels: string[]): string {
  const parts = [`${plural(race.survivors, "configuration")} of ${count(total)} still in`];
  parts.push(plural(race.runs, "run"));
  if (race.left_s !== null) parts.push(`about ${duration(race.left_s)} left`);
  const [best] = race.standings;
  const leads = best ? ` In front: ${nameOf(labels, best[0])}.` : "";
  return `${stateWords[race.state]}: ${parts.join(", ")}.${leads}`;
}

/** The numbers of a race, each with what it is. */
export function figuresOf(race: Studying, total: number): [value: string, words: string][] {
  const first: [string, string][] = [
    [`${count(race.survivors)} of ${count(total)}`, "still in"],
    [count(race.runs), "runs"],
    [count(race.round), "round"],
  ];
  if (race.state !== "running") return [...first, [race.seconds > 0 ? duration(race.seconds) : "–", "taken"]];
  const left = race.left_s === null ? "–" : duration(race.left_s);
  // Of one in another process nobody knows.
  const rate = race.seconds > 0 ? count(race.runs_per_s) : "–";
  return [...first, [rate, "runs a second"], [left, "left, about"]];
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

/** How long ago, such as `3 minutes ago`. */
export function ago(changed_s: number, now_s: number): string {
  const words = new Intl.RelativeTimeFormat("en", { numeric: "auto" });
  const past = Math.max(0, now_s - changed_s);
  if (past < 60) return "just now";
  if (past < 3600) return words.format(-Math.floor(past / 60), "minute");
  if (past < 86_400) return words.format(-Math.floor(past / 3600), "hour");
  return words.format(-Math.floor(past / 86_400), "day");
}

/** Decimals of merits, so that `delta` has two figures. */
export function places(delta: number): number {
  return Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(delta))));
}

export function decimal(value: number | null, digits: number): string {
  return value === null ? "–" : value.toFixed(digits).replace("-", "−");
}

export function percent(share: number): string {
  return `${Number((100 * share).toFixed(6))}%`;
}

/** What went wrong, for people. */
export function troubleOf(fault: unknown): string {
  // `fetch` throws TypeErrors of the browser's own words where there is no server.
  if (fault instanceof TypeError || !(fault instanceof Error)) return "The server does not answer.";
  return fault.message;
}
