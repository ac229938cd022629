import type { Point, Pose, Reach } from "../api/protocol";
import { rgb } from "./colours";

/** The utility of each course, from 0 for the worst of them to 1 for the best. */
export function worths({ courses }: Reach): number[] {
  const utilities = courses.map((course) => course.utility);
  const [least, most] = [Math.min(...utilities), Math.max(...utilities)];
  return utilities.map((utility) => (most > least ? (utility - least) / (most - least) : 1));
}

/** Where in the world a place is that a robot has before its front. */
export function placeOf({ at, heading_rad }: Pose, [ahead, left]: Point): Point {
  const [cos, sin] = [Math.cos(heading_rad), Math.sin(heading_rad)];
  return [at[0] + cos * ahead - sin * left, at[1] + sin * ahead + cos * left];
}

/** A colour so far from one to another. */
export function mixed(from: string, to: string, share: number): string {
  const [start, end] = [rgb(from), rgb(to)];
  const parts = start.map((value, i) => Math.round(255 * (value + share * ((end[i] ?? 0) - value))));
  return `rgb(${parts.join(" ")})`;
}
