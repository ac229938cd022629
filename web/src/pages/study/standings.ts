import type { Standing, StudyProgress } from "../../api/study";

/** Whether the standings have ranges; those of a stopped study have none. */
export function hasRanges(standings: Standing[]): boolean {
  return standings.some(([, , , low, high]) => low !== null && high !== null);
}

/** The race after a message. A stopped race keeps the last ranges, with the statuses of the message. */
export function updatedRace(before: StudyProgress | null, message: StudyProgress): StudyProgress {
  const keepsRanges = before !== null && message.state !== "running" && !hasRanges(message.standings);
  if (!keepsRanges) return message;
  const statuses = new Map(
    message.standings.map(([configuration, , , , , status]) => [configuration, status]),
  );
  const standings = before.standings.map(([configuration, runs, value, low, high, status]): Standing => {
    return [configuration, runs, value, low, high, statuses.get(configuration) ?? status];
  });
  return { ...message, standings };
}
