/** What a robot perceived and decided, as text and coordinates for display. */
import type { Point, RingView, RobotMessage } from "../../api/protocol";

/** The ends of range rays in the robot's frame. Rays without a reading end at the sensor's range. */
export function rayEnds({ bearings_rad, range_m }: RingView, ranges_m: (number | null)[]): Point[] {
  return ranges_m.map((range, i) => pointAt(range ?? range_m, bearings_rad[i] ?? 0));
}

/** The point at a range and bearing, in the robot's frame. */
export function pointAt(range_m: number, bearing_rad: number): Point {
  return [range_m * Math.cos(bearing_rad), range_m * Math.sin(bearing_rad)];
}

/** Messages counted by subject: "3 about items, 1 about the sender". */
export function messageCounts(messages: RobotMessage[]): string {
  const counts = new Map<string, number>();
  for (const { about } of messages) {
    const kind = Object.keys(about)[0] ?? "nothing";
    counts.set(kind, (counts.get(kind) ?? 0) + 1);
  }
  return [...counts].map(([kind, count]) => `${count} about ${names[kind] ?? kind}`).join(", ") || "none";
}

const names: Record<string, string> = {
  item: "items",
  sender: "the sender",
  goal: "goals",
  order: "orders",
  contract: "goals of controllers",
  lease: "leases",
  ownership: "the ownership of goals",
  lane: "mined lanes",
};

/** Such as "12° left"; positive bearings are anticlockwise, to the left. */
export function bearingText(bearing_rad: number): string {
  const degrees = Math.round((bearing_rad * 180) / Math.PI);
  if (degrees === 0) return "ahead";
  return `${Math.abs(degrees)}° ${degrees > 0 ? "left" : "right"}`;
}

/** Such as `57°/s left`. */
export function turnText(rate_rad_s: number): string {
  const degrees = Math.round((rate_rad_s * 180) / Math.PI);
  if (degrees === 0) return "straight";
  return `${Math.abs(degrees)}°/s ${degrees > 0 ? "left" : "right"}`;
}
