import { expect, test } from "vitest";
import type { Standing, Studying } from "../../api/study";
import { following, hasRanges } from "./standings";

const ranged: Standing[] = [[3, 40, -1.5, -1.7, -1.3]];
const bare: Standing[] = [[3, 40, -1.5, null, null]];
const race = (state: Studying["state"], standings: Standing[]) => ({ state, standings }) as Studying;

test("ranges that were seen stay when the study is stopped", () => {
  expect(following(race("running", ranged), race("stopped", bare)).standings).toBe(ranged);
});

test("a study that runs is shown as it is told, also without ranges", () => {
  expect(following(race("running", ranged), race("running", bare)).standings).toBe(bare);
  expect(following(null, race("stopped", bare)).standings).toBe(bare);
  expect(hasRanges(bare)).toBe(false);
});
