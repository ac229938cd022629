/** The points of a line: a value is null where there is none. */
export interface Points {
  ticks: number[];
  values: (number | null)[];
}

/** CSV of exactly these points, with a row for each tick at which a line has one. */
export function csv(lines: { id: string; points: Points }[], step_s: number): string {
  const columns = lines.map(({ points }) => new Map(points.ticks.map((tick, i) => [tick, points.values[i]])));
  const ticks = [...new Set(lines.flatMap(({ points }) => points.ticks))].sort((one, other) => one - other);
  const rows = ticks.map((tick) => [
    tick,
    Number((tick * step_s).toPrecision(12)),
    ...columns.map((column) => column.get(tick) ?? ""),
  ]);
  const header = ["tick", "time_s", ...lines.map(({ id }) => quoted(id))];
  return [header, ...rows].map((row) => `${row.join(",")}\n`).join("");
}

function quoted(name: string): string {
  return /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
}
