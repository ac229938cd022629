import type { Position, WardenRobot } from "../../api/warden";
import { writeAngle, writePoint } from "./angle";
import { ageOf, isOld } from "./words";

/** An input whose value is doubted. */
export interface Doubt {
  port: string;
  /** Its newest value in the terms of the operator, to be compared with what is seen at the robot. */
  value: string;
  /** Why its value cannot be confirmed now. */
  reasons: string[];
  /** Changes with what is to be confirmed: another robot, or another jump. */
  key: string;
}

/** The doubted inputs of a robot. */
export function doubtsOf(robot: WardenRobot): Doubt[] {
  const { name, doubted, faults, warnings, links } = robot;
  const why = [...faults, ...warnings].filter((fault) => ["jump", "frozen"].includes(fault.name));
  return doubted.map((port) => {
    const [value, link] = [valueOf(robot, port), links.find((each) => each.port === port)];
    const reasons = value === null ? ["no value is known"] : [];
    if (value !== null && (!link || isOld(link)))
      reasons.push(`its value is old: ${link ? ageOf(link) : "?"}`);
    return { port, value: value ?? "unknown", reasons, key: JSON.stringify([name, port, why]) };
  });
}

/** The newest value of a port; null if none is known. */
function valueOf({ heading, position, ranges }: WardenRobot, port: string): string | null {
  if (heading?.port === port) return `${headingOf(heading.magnetic_deg)} degrees magnetic`;
  if (position?.port === port) return coordinatesOf(position);
  if (ranges?.port !== port) return null;
  return ranges.values_m.map((value_m, i) => rangeOf(value_m, ranges.is_known[i] === true)).join(", ");
}

/** Rounded first, so that no heading is written as 360.0. */
function headingOf(magnetic_deg: number): string {
  return ((Math.round(10 * magnetic_deg) % 3600) / 10).toFixed(1);
}

function coordinatesOf({ latitude_deg, longitude_deg, x_m, y_m }: Position): string {
  const point = unbroken(writePoint(x_m, y_m));
  if (latitude_deg === null || longitude_deg === null) return point;
  const angles = [writeAngle("latitude", latitude_deg), writeAngle("longitude", longitude_deg)].map(unbroken);
  return `${angles.join(", ")} ${point}`;
}

function rangeOf(value_m: number | null, isKnown: boolean): string {
  if (value_m !== null) return unbroken(`${value_m.toFixed(1)} m`);
  return isKnown ? unbroken("no echo") : "unknown";
}

/** The same words, never broken into lines. */
const unbroken = (text: string) => text.replaceAll(" ", "\u00a0");
