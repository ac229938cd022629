import type { Frame } from "../api/frames";
import { maxLinks } from "../api/overlay";
import type { KindView, Setting } from "../api/protocol";

/** The robots of one kind have the numbers `first` to `first + count - 1`. */
export interface Range {
  kind: KindView;
  first: number;
  count: number;
}

/** Labels of robot states, indexed by the number in frames. */
export const stateLabels = ["clear", "about to collide", "collided", "battery empty", "broken"];

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

const externals = new WeakMap<Setting, number[]>();

/** The numbers of the robots with external bodies that are in the team. */
export function externalOf(setting: Setting): number[] {
  let found = externals.get(setting);
  if (!found) {
    found = setting.external.map((name) => setting.robots.indexOf(name)).filter((robot) => robot >= 0);
    externals.set(setting, found);
  }
  return found;
}

/** The number of robots that a robot receives from; null if its links may be incomplete (`maxLinks`). */
export function sendersOf(links: Uint32Array, robot: number): number | null {
  let [own, senders] = [0, 0];
  for (let i = 0; i < links.length; i += 3) {
    if (links[i] !== robot && links[i + 1] !== robot) continue;
    own += 1;
    if (links[i + 1] === robot || links[i + 2] === 1) senders += 1;
  }
  return own < maxLinks ? senders : null;
}

/** The number of robots in each state. */
export function countStates(frame: Frame | null): number[] {
  const counts = stateLabels.map(() => 0);
  if (!frame) return counts;
  for (let i = 3; i < frame.robots.length; i += 4) {
    const state = frame.robots[i] ?? 0;
    counts[state] = (counts[state] ?? 0) + 1;
  }
  return counts;
}

/** Number of the nearest robot within `tolerance` of a point, or covering it; -1 if there is none. */
export function robotAt(frame: Frame, setting: Setting, x: number, y: number, tolerance: number): number {
  let [best, nearest] = [-1, Number.POSITIVE_INFINITY];
  for (const { kind, first, count } of rangesOf(setting)) {
    const covered = Math.max(tolerance, kind.radius);
    for (let i = first; i < Math.min(first + count, frame.count); i++) {
      const distance = Math.hypot((frame.robots[4 * i] ?? 0) - x, (frame.robots[4 * i + 1] ?? 0) - y);
      if (distance <= covered && distance < nearest) [best, nearest] = [i, distance];
    }
  }
  return best;
}
