import type { Frame } from "../api/frames";
import { mostLinks } from "../api/overlay";
import type { KindView, Setting } from "../api/protocol";

/** The robots of one kind: those with numbers from `first` on. */
export interface Range {
  kind: KindView;
  first: number;
  count: number;
}

/** Words for the states of robots, by their number in frames. */
export const stateWords = ["clear", "in danger", "collided", "battery empty", "broken"];

const ranges = new WeakMap<Setting, Range[]>();

export function rangesOf(setting: Setting): Range[] {
  let found = ranges.get(setting);
  if (!found) {
    let first = 0;
    found = setting.kinds.map((kind) => {
      const range = { kind, first, count: kind.count };
      first += kind.count;
      return range;
    });
    ranges.set(setting, found);
  }
  return found;
}

export function kindOf(setting: Setting, robot: number): KindView | null {
  return rangesOf(setting).find(({ first, count }) => robot >= first && robot < first + count)?.kind ?? null;
}

/** How many others a robot hears, given links with all of its own; null if some of these may not be told. */
export function heardBy(links: Uint32Array, robot: number): number | null {
  let [own, heard] = [0, 0];
  for (let i = 0; i < links.length; i += 3) {
    if (links[i] !== robot && links[i + 1] !== robot) continue;
    own += 1;
    if (links[i + 1] === robot || links[i + 2] === 1) heard += 1;
  }
  return own < mostLinks ? heard : null;
}

/** How many robots are in each state. */
export function countStates(frame: Frame | null): number[] {
  const counts = stateWords.map(() => 0);
  if (!frame) return counts;
  for (let i = 3; i < frame.robots.length; i += 4) {
    const state = frame.robots[i] ?? 0;
    counts[state] = (counts[state] ?? 0) + 1;
  }
  return counts;
}

/** The robot nearest to a place, if one is within `reach` of it or covers it; else -1. */
export function robotAt(frame: Frame, setting: Setting, x: number, y: number, reach: number): number {
  let [best, nearest] = [-1, Number.POSITIVE_INFINITY];
  for (const { kind, first, count } of rangesOf(setting)) {
    const covered = Math.max(reach, kind.radius);
    for (let i = first; i < Math.min(first + count, frame.count); i++) {
      const distance = Math.hypot((frame.robots[4 * i] ?? 0) - x, (frame.robots[4 * i + 1] ?? 0) - y);
      if (distance <= covered && distance < nearest) [best, nearest] = [i, distance];
    }
  }
  return best;
}
