import type { Cell, StudyRun } from "../../api/study";
import { withoutFindTimes } from "../../shared/outcome";

const first = ["merit", "time_s", "failed"];
const apart = ["run", "quantile"];

const ofItems = ["found", "missed", "false_alarms"];

/** The columns of runs, those of the merit first, without the times of finds, and without those of items if there are none. */
export function columnsOf(runs: StudyRun[]): string[] {
  const all = Object.keys(runs[0] ?? {});
  const lacksItems = all.includes("missed") && !all.some((name) => name.startsWith("missed_"));
  const left = lacksItems ? [...apart, ...ofItems] : apart;
  const names = withoutFindTimes(all).filter((name) => !left.includes(name));
  const rest = names.filter((name) => !first.includes(name));
  return [...first.filter((name) => names.includes(name)), ...rest];
}

export function cellText(value: Cell): string {
  if (value === null) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value === "string") return value;
  if (Number.isInteger(value)) return value.toLocaleString("en").replace("-", "−");
  const digits = Math.abs(value) >= 100 ? 0 : Math.abs(value) >= 10 ? 1 : 2;
  const figures = { minimumFractionDigits: digits, maximumFractionDigits: digits };
  return value.toLocaleString("en", figures).replace("-", "−");
}

/** Whether all cells are numbers, with or without a range, status or unit; such columns are right-aligned. */
export function areNumbers(cells: string[]): boolean {
  return (
    cells.length > 0 &&
    cells.every((cell) => /^(([−-]?[\d.,]+( ?%)?|[–—])( \(.*\))?|not known)$/.test(cell.trim()))
  );
}

export function quantileText(quantile: number): string {
  if (quantile === 0) return "worst";
  if (quantile === 1) return "best";
  if (quantile === 0.5) return "median";
  return `${Math.round(100 * quantile)}%`;
}
