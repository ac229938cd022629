/** Numbers with their units. */

export function seconds(time_s: number): string {
  return `${time_s.toFixed(1)} s`;
}

/** Such as `300 bytes`, `12 kB` or `6.3 MB`. */
export function bytes(count: number): string {
  if (count < 1000) return plural(count, "byte");
  return count < 1e6 ? `${(count / 1e3).toFixed(0)} kB` : `${(count / 1e6).toFixed(1)} MB`;
}

/** Such as `3.1`, `120` or `0.25`. */
export function times(factor: number): string {
  return factor >= 100 ? factor.toFixed(0) : factor.toPrecision(2).replace(/\.0$/, "");
}

export function plural(count: number, word: string): string {
  return `${count.toLocaleString("en")} ${word}${count === 1 ? "" : "s"}`;
}
