import { expect, test } from "vitest";
import { worldHeading_rad } from "./map";
import { withSlider } from "./manual";

test("a compass heading is turned by declination and by the rotation of the world", () => {
  const origin = { latitude_deg: 0, longitude_deg: 0 };
  expect(worldHeading_rad(0, origin)).toBeCloseTo(Math.PI / 2);
  expect(worldHeading_rad(90, origin)).toBeCloseTo(0);
  expect(worldHeading_rad(60, { ...origin, declination_deg: 30 })).toBeCloseTo(0);
  expect(worldHeading_rad(120, { ...origin, rotation_deg: 30 })).toBeCloseTo(0);
});

test("the combined slider moves both tracks, each other slider its own", () => {
  expect(withSlider({ left: 150, right: 160 }, "both", 180)).toEqual({ left: 180, right: 180 });
  expect(withSlider({ left: 150, right: 160 }, "left", 180)).toEqual({ left: 180, right: 160 });
});
