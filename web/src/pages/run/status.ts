import type { State } from "../../api/protocol";
import { plural, seconds, times } from "../../shared/format";
import { stateWords } from "../../shared/robots";
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
