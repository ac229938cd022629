import type { State } from "../net/protocol";
import { stateWords } from "./robots";
import type { Phase } from "./session.svelte";

/** What the picture says, in words. */
export function statusWords(state: State | null, robots: number[], items: number, phase: Phase): string {
  if (phase === "lost") return "The connection is lost.";
  if (phase === "ended") return "The run has ended.";
  if (!state) return "Loading.";
  const parts = [`${seconds(state.time_s)}, ${robotWords(robots)}`];
  if (items > 0) parts.push(`${Number(state.outcome.found ?? 0)} of ${items} items found`);
  return `${parts.concat(motion(state)).join("; ")}.`;
}

export function seconds(time_s: number): string {
  return `${time_s.toFixed(1)} s`;
}

/** Such as `300 bytes`, `12 kB` or `6.3 MB`. */
export function bytes(count: number): string {
  if (count < 1000) return plural(count, "byte");
  return count < 1e6 ? `${(count / 1e3).toFixed(0)} kB` : `${(count / 1e6).toFixed(1)} MB`;
}

/** Such as `3.1`, `120` or `0.25`. */
export function times(factor: number): string {
  return factor >= 100 ? factor.toFixed(0) : factor.toPrecision(2).replace(/\.0$/, "");
}

export function plural(count: number, word: string): string {
  return `${count.toLocaleString("en")} ${word}${count === 1 ? "" : "s"}`;
}

function robotWords(counts: number[]): string {
  const all = counts.reduce((sum, count) => sum + count, 0);
  const rest = counts.flatMap((count, i) => (i > 0 && count > 0 ? [`${count} ${stateWords[i]}`] : []));
  const words = rest.length > 0 ? rest.join(", ") : all > 0 ? "all clear" : "";
  return words ? `${plural(all, "robot")}: ${words}` : plural(all, "robot");
}

function motion(state: State): string {
  if (state.over) return "the run is over";
  if (state.playing) return `running at ${times(state.real)} times real time`;
  return state.aim === null ? "paused" : "on its way";
}
