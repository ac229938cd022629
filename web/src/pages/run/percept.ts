/** What a robot perceived and decided, as text and coordinates for display. */
import type { Point, RingView, Said } from "../../api/protocol";

/** Where rays end, from the robot's front; those that met nothing end where the sensor does. */
export function ends({ bearings_rad, range_m }: RingView, ranges_m: (number | null)[]): Point[] {
  return ranges_m.map((range, i) => at(range ?? range_m, bearings_rad[i] ?? 0));
}

/** A place so far away, at a bearing from the front. */
export function at(range_m: number, bearing_rad: number): Point {
  return [range_m * Math.cos(bearing_rad), range_m * Math.sin(bearing_rad)];
}

/** Messages by what they are about: "3 about items, 1 about itself". */
export function counted(said: Said[]): string {
  const counts = new Map<string, number>();
  for (const { about } of said) {
    const kind = Object.keys(about)[0] ?? "nothing";
    counts.set(kind, (counts.get(kind) ?? 0) + 1);
  }
  return [...counts].map(([kind, count]) => `${count} about ${names[kind] ?? kind}`).join(", ") || "none";
}

const names: Record<string, string> = { item: "items", sender: "itself", goal: "goals" };

/** "12° left": what is anticlockwise from the front is on the left. */
export function aside(bearing_rad: number): string {
  const degrees = Math.round((bearing_rad * 180) / Math.PI);
  if (degrees === 0) return "ahead";
  return `${Math.abs(degrees)}° ${degrees > 0 ? "left" : "right"}`;
}

/** A rate of turn in words. */
export function turning(rate_rad_s: number): string {
  const degrees = Math.round((rate_rad_s * 180) / Math.PI);
  if (degrees === 0) return "straight";
  return `${Math.abs(degrees)}°/s to the ${degrees > 0 ? "left" : "right"}`;
}
