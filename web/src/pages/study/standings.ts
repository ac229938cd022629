import type { Standing, Studying } from "../../api/study";

/** Whether the server has computed any ranges: of a study that stands it has none. */
export function hasRanges(standings: Standing[]): boolean {
  return standings.some(([, , , low, high]) => low !== null && high !== null);
}

/** What is known of a race after a message: the ranges that were seen last hold on while it stands. */
export function following(before: Studying | null, message: Studying): Studying {
  const stays = before !== null && message.state !== "running" && !hasRanges(message.standings);
  return stays ? { ...message, standings: before.standings } : message;
}
