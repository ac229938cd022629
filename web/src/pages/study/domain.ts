import type { Standing } from "../../api/study";

export type Domain = [low: number, high: number];

/** If the intervals cover less than this share of the axis, it is narrowed. */
const minShare = 0.35;

/** The ends of an axis that contains all intervals; unchanged while the intervals cover enough of it. */
export function domainFor(before: Domain | null, standings: Standing[]): Domain | null {
  const ends = standings
    .flatMap(([, , value, low, high]) => [value, low, high])
    .filter((end) => end !== null);
  if (ends.length === 0) return before;
  const [low, high] = [Math.min(...ends), Math.max(...ends)];
  const isHeld = before !== null && low >= before[0] && high <= before[1];
  if (isHeld && high - low >= minShare * (before[1] - before[0])) return before;
  return rounded(low, high);
}

/** Round values along a domain, including its ends if they are round. */
export function ticksOf([low, high]: Domain, maxCount = 6): number[] {
  const step = stepOf((high - low) / maxCount);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => tidy((first + i) * step));
}

/** The position of a value, in percent of the axis. */
export function placeOn([low, high]: Domain, value: number): number {
  return Math.min(100, Math.max(0, (100 * (value - low)) / (high - low)));
}

/** Whether a value is between the ends of the axis. */
export function isOn([low, high]: Domain, value: number): boolean {
  return low <= value && value <= high;
}

function rounded(low: number, high: number): Domain {
  const width = Math.max(high - low, 1e-6 * Math.max(1, Math.abs(low)));
  const step = stepOf(width / 5);
  const end = Math.max(high, low + width);
  return [tidy(Math.floor(low / step + 1e-9) * step), tidy(Math.ceil(end / step - 1e-9) * step)];
}

/** Removes rounding errors of binary fractions. */
function tidy(value: number): number {
  return Number(value.toPrecision(12));
}

/** The smallest of 1, 2, 5, 10, ... that is not below `raw`. */
function stepOf(raw: number): number {
  const power = 10 ** Math.floor(Math.log10(raw));
  const factor = [1, 2, 5, 10].find((one) => one * power >= raw * (1 - 1e-9)) ?? 10;
  return factor * power;
}
