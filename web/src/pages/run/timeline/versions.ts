import type { Setting, VersionView } from "../../../api/protocol";
import { ancestors } from "./events";

/** A version in the list, indented by the number of branches that lead to it. */
export interface Branch {
  version: VersionView;
  depth: number;
  /** Whether the current version contains its change. */
  isOn: boolean;
}

/**
 * The versions as a tree: a version follows the one in which its change was made; of several, those that were made
 * later are indented and come first, as the current one usually is the last.
 */
export function tree(setting: Setting): Branch[] {
  const on = new Set(ancestors(setting).map(({ number }) => number));
  const children = new Map<number | null, VersionView[]>();
  for (const version of setting.versions) {
    const { parent } = version;
    children.set(parent, [...(children.get(parent) ?? []), version]);
  }
  const found: Branch[] = [];
  const waiting = (children.get(null) ?? []).map((version) => ({ version, depth: 0 }));
  for (let next = waiting.pop(); next; next = waiting.pop()) {
    const { version, depth } = next;
    found.push({ version, depth, isOn: on.has(version.number) });
    const own = children.get(version.number) ?? [];
    // The one that the current version contains continues in the same column; it is listed last.
    const main = own.find(({ number }) => on.has(number)) ?? own.at(-1);
    if (main) waiting.push({ version: main, depth });
    for (const other of own) if (other !== main) waiting.push({ version: other, depth: depth + 1 });
  }
  return found;
}

/** The versions that were left, and that begin in the current one: where they do. */
export function branchTicks(setting: Setting): number[] {
  const on = new Set(ancestors(setting).map(({ number }) => number));
  const left = setting.versions.filter(({ number, parent }) => !on.has(number) && on.has(parent ?? -1));
  return [...new Set(left.map(({ tick }) => tick))];
}
