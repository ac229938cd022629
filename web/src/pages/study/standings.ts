import type { Standing, StudyProgress } from "../../api/study";

/** Whether the standings have ranges; those of a stopped study have none. */
export function hasRanges(standings: Standing[]): boolean {
  return standings.some(([, , , low, high]) => low !== null && high !== null);
}

/** The race after a message. A stopped race keeps the last ranges. */
export function updatedRace(before: StudyProgress | null, message: StudyProgress): StudyProgress {
  const keepsRanges = before !== null && message.state !== "running" && !hasRanges(message.standings);
  return keepsRanges ? { ...message, standings: before.standings } : message;
}
