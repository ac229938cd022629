import type { Angle } from "../../api/warden";

export type Axis = "latitude" | "longitude";

export const hemispheres: Record<Axis, [string, string]> = { latitude: ["N", "S"], longitude: ["E", "W"] };
const maxDegrees: Record<Axis, number> = { latitude: 90, longitude: 180 };

/** The angle of what was typed, or what is wrong with it. */
export type Parsed = { angle: Angle } | { error: string };

export function parseAngle(axis: Axis, degrees: string, minutes: string, hemisphere: string): Parsed {
  const max = maxDegrees[axis];
  if (!/^\s*\d{1,3}\s*$/.test(degrees) || Number(degrees) > max) {
    return { error: `Degrees of ${axis}: expected a whole number from 0 to ${max}.` };
  }
  if (!/^\s*\d{1,2}(\.\d*)?\s*$/.test(minutes) || Number(minutes) >= 60) {
    return { error: `Minutes of ${axis}: expected a number from 0 to less than 60, such as 35.7160.` };
  }
  if (Number(degrees) === max && Number(minutes) > 0) {
    return { error: `The ${axis} is more than ${max} degrees.` };
  }
  return { angle: { degrees: Number(degrees), minutes: Number(minutes), hemisphere } };
}

/** Where something is. */
interface Place {
  x_m: number;
  y_m: number;
  latitude_deg: number | null;
  longitude_deg: number | null;
}

/** Latitude and longitude of a place; its coordinates on the map if it is too far from it to have any. */
export function writePlace({ x_m, y_m, latitude_deg, longitude_deg }: Place): string {
  if (latitude_deg === null || longitude_deg === null) return writePoint(x_m, y_m);
  return `${writeAngle("latitude", latitude_deg)}, ${writeAngle("longitude", longitude_deg)}`;
}

/** Coordinates on the map. */
export function writePoint(x_m: number, y_m: number): string {
  return `(${x_m.toFixed(1)}, ${y_m.toFixed(1)} m on the map)`;
}

/** Degrees, minutes and hemisphere of an angle, such as 36° 35.7160′ N. */
export function writeAngle(axis: Axis, value_deg: number): string {
  const hemisphere = hemispheres[axis][value_deg < 0 ? 1 : 0];
  // Rounded first, so that no minutes are written as 60.
  const tenThousandths = Math.round(Math.abs(value_deg) * 600_000);
  const minutes = ((tenThousandths % 600_000) / 10_000).toFixed(4);
  return `${Math.floor(tenThousandths / 600_000)}° ${minutes}′ ${hemisphere}`;
}
