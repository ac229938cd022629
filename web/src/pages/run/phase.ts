/** The states of the connection between a page and its run. */
import type { Ended, InputError, Speed, State } from "../../api/protocol";

/** `opening` until the server confirms the run; `lost` while reconnecting. */
export type Phase =
  | { name: "opening" }
  | { name: "open" }
  /** The next attempt is in `retry_ms`; playback then continues at `resumeSpeed`, unless it is undefined. */
  | { name: "lost"; retry_ms: number; resumeSpeed: Speed | undefined }
  /** The run could not be opened. */
  | { name: "refused"; errors: InputError[]; total: number }
  | { name: "ended"; ended: Ended };

/** The phase after the connection is lost; null if it is not to be restored. Without `state`, nothing is resumed. */
export function lostPhase(phase: Phase, state: State | null, retry_ms: number): Phase | null {
  const { name } = phase;
  if (name === "refused" || name === "ended") return null;
  if (name === "lost") return { ...phase, retry_ms };
  const isResumed = name === "open" && state?.is_playing;
  return { name: "lost", retry_ms, resumeSpeed: isResumed ? state.speed : undefined };
}
