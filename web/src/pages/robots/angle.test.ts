import { describe, expect, test } from "vitest";
import { parseAngle, writeAngle, writePlace } from "./angle";

describe("degrees and minutes", () => {
  test("are read with their hemisphere, which is never assumed", () => {
    expect(parseAngle("longitude", "121", "52.5002", "W")).toEqual({
      angle: { degrees: 121, minutes: 52.5002, hemisphere: "W" },
    });
    expect(parseAngle("latitude", " 0 ", "0", "S")).toEqual({
      angle: { degrees: 0, minutes: 0, hemisphere: "S" },
    });
  });

  test.each([
    ["latitude", "91", "0"],
    ["longitude", "181", "0"],
    ["latitude", "-36", "0"],
    ["latitude", "36.5", "0"],
    ["latitude", "", "0"],
    ["latitude", "36", "60"],
    ["latitude", "36", ""],
    ["latitude", "36", "1,5"],
    ["latitude", "36", "1e1"],
    ["latitude", "90", "0.1"],
    ["longitude", "NaN", "0"],
  ] as const)("are refused with the reason: %s %s %s", (axis, degrees, minutes) => {
    expect(parseAngle(axis, degrees, minutes, "N")).toEqual({ error: expect.stringContaining(axis) });
  });

  test("are written without 60 minutes", () => {
    expect(writeAngle("latitude", 36.595267)).toBe("36° 35.7160′ N");
    expect(writeAngle("longitude", -121.99999999)).toBe("122° 0.0000′ W");
  });

  test("of a place too far from the map are replaced by its coordinates", () => {
    const place = { x_m: 0, y_m: 1, latitude_deg: 36.595267, longitude_deg: -121.5 };
    expect(writePlace(place)).toBe("36° 35.7160′ N, 121° 30.0000′ W");
    expect(writePlace({ ...place, x_m: 9e6, latitude_deg: null, longitude_deg: null })).toBe(
      "(9000000.0, 1.0 m on the map)",
    );
  });
});
