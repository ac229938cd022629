import { expect, test } from "vitest";
import type { Standing, StudyProgress } from "../../api/study";
import { updatedRace, hasRanges } from "./standings";

const ranged: Standing[] = [[3, 40, -1.5, -1.7, -1.3, null]];
const bare: Standing[] = [[3, 40, -1.5, null, null, null]];
const race = (state: StudyProgress["state"], standings: Standing[]) =>
  ({ state, standings }) as StudyProgress;

test("a stopped study keeps its last ranges", () => {
  expect(updatedRace(race("running", ranged), race("stopped", bare)).standings).toEqual(ranged);
});

test("a stopped study has its last statuses", () => {
  const open: Standing[] = [[3, 40, 0.9, 0.7, 1, "open"]];
  const certified: Standing[] = [[3, 44, 0.9, null, null, "certified"]];
  const stopped = updatedRace(race("running", open), race("stopped", certified));
  expect(stopped.standings).toEqual([[3, 40, 0.9, 0.7, 1, "certified"]]);
});

test("a running study follows each message, also without ranges", () => {
  expect(updatedRace(race("running", ranged), race("running", bare)).standings).toBe(bare);
  expect(updatedRace(null, race("stopped", bare)).standings).toBe(bare);
  expect(hasRanges(bare)).toBe(false);
});
