import type { HeadingOptions, Point, Pose } from "../api/protocol";
import { rgb } from "./colours";

/** The utility of each heading option, scaled from 0 (lowest) to 1 (highest). */
export function relativeUtilities({ headings }: HeadingOptions): number[] {
  const utilities = headings.map(({ utility }) => utility);
  const [min, max] = [Math.min(...utilities), Math.max(...utilities)];
  return utilities.map((utility) => (max > min ? (utility - min) / (max - min) : 1));
}

/** Transforms a point from the robot's frame to the world. */
export function toWorldFrame({ at, heading_rad }: Pose, [ahead, left]: Point): Point {
  const [cos, sin] = [Math.cos(heading_rad), Math.sin(heading_rad)];
  return [at[0] + cos * ahead - sin * left, at[1] + sin * ahead + cos * left];
}

/** Interpolates between two colours. */
export function mixColours(from: string, to: string, share: number): string {
  const [start, end] = [rgb(from), rgb(to)];
  const parts = start.map((value, i) => Math.round(255 * (value + share * ((end[i] ?? 0) - value))));
  return `rgb(${parts.join(" ")})`;
}
