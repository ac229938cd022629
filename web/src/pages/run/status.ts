import type { State } from "../../api/protocol";
import { plural, seconds, times } from "../../shared/format";
import { stateLabels } from "../../shared/robots";
import type { Phase } from "./phase";

/** The state of the run in one sentence, for screen readers and below the canvas. */
export function statusText(
  state: State | null,
  robots: number[],
  items: number,
  phase: Phase["name"],
  isMovedHere = true,
): string {
  if (phase === "lost") return "The connection is lost.";
  if (phase === "ended") return "The run has ended.";
  if (!state) return "Loading…";
  const parts = [`${seconds(state.time_s)}, ${robotText(robots)}`];
  if (items > 0) parts.push(`${Number(state.outcome.found ?? 0)} of ${items} items found`);
  if (isMovedHere || state.is_over) parts.push(motion(state));
  return `${parts.join("; ")}.`;
}

function robotText(counts: number[]): string {
  const all = counts.reduce((sum, count) => sum + count, 0);
  const rest = counts.flatMap((count, i) => (i > 0 && count > 0 ? [`${count} ${stateLabels[i]}`] : []));
  const text = rest.length > 0 ? rest.join(", ") : all > 0 ? "all clear" : "";
  return text ? `${plural(all, "robot")}: ${text}` : plural(all, "robot");
}

function motion(state: State): string {
  if (state.is_over) return "finished";
  if (state.is_playing) return `running at ${times(state.measured_speed)} × real time`;
  return state.target_tick === null ? "paused" : "computing";
}
