import type { Json } from "../api/protocol";

/** A value of the scenario in which two runs differ. */
export interface Changed {
  path: string;
  left: string;
  right: string;
}

const absent = "–";
const longest = 60;

/** The values in which two documents differ, by path. */
export function documentsOf(left: Json | undefined, right: Json | undefined, path = ""): Changed[] {
  if (isTable(left) && isTable(right)) {
    const keys = [...new Set([...Object.keys(left), ...Object.keys(right)])];
    return keys.flatMap((key) => documentsOf(left[key], right[key], path === "" ? key : `${path}.${key}`));
  }
  return JSON.stringify(left) === JSON.stringify(right)
    ? []
    : [{ path, left: shown(left), right: shown(right) }];
}

function isTable(value: Json | undefined): value is Record<string, Json> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function shown(value: Json | undefined): string {
  if (value === undefined) return absent;
  const text = JSON.stringify(value);
  return text.length > longest ? `${text.slice(0, longest - 1)}…` : text;
}

/** A number with at most four digits that matter. */
export function readable(value: number | null): string {
  if (value === null) return absent;
  if (Number.isInteger(value)) return value.toLocaleString("en");
  return Number(value.toPrecision(4)).toLocaleString("en", { maximumFractionDigits: 6 });
}
