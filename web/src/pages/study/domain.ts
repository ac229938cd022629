import type { Standing } from "../../api/study";

export type Domain = [low: number, high: number];

/** Below this share of the axis the intervals are looked at more closely. */
const least = 0.35;

/** Ends of an axis that holds all intervals: those before, as long as these are large enough on it. */
export function domainFor(before: Domain | null, standings: Standing[]): Domain | null {
  const ends = standings
    .flatMap(([, , value, low, high]) => [value, low, high])
    .filter((end) => end !== null);
  if (ends.length === 0) return before;
  const [low, high] = [Math.min(...ends), Math.max(...ends)];
  const isHeld = before !== null && low >= before[0] && high <= before[1];
  if (isHeld && high - low >= least * (before[1] - before[0])) return before;
  return rounded(low, high);
}

/** Round values along a domain, both ends of round ones included. */
export function ticksOf([low, high]: Domain, most = 6): number[] {
  const step = stepOf((high - low) / most);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => tidy((first + i) * step));
}

/** Where a value lies, in percent of the axis. */
export function placeOn([low, high]: Domain, value: number): number {
  return Math.min(100, Math.max(0, (100 * (value - low)) / (high - low)));
}

function rounded(low: number, high: number): Domain {
  const width = Math.max(high - low, 1e-6 * Math.max(1, Math.abs(low)));
  const step = stepOf(width / 5);
  const end = Math.max(high, low + width);
  return [tidy(Math.floor(low / step + 1e-9) * step), tidy(Math.ceil(end / step - 1e-9) * step)];
}

/** Without what sums of binary fractions leave. */
function tidy(value: number): number {
  return Number(value.toPrecision(12));
}

/** The next of 1, 2, 5, 10, ... that is no smaller. */
function stepOf(raw: number): number {
  const power = 10 ** Math.floor(Math.log10(raw));
  const factor = [1, 2, 5, 10].find((one) => one * power >= raw * (1 - 1e-9)) ?? 10;
  return factor * power;
}
