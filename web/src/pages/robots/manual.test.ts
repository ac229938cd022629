import { expect, test } from "vitest";
import { withSlider } from "./manual";

test("the combined slider moves both tracks, each other slider its own", () => {
  expect(withSlider({ left: 150, right: 160 }, "both", 180)).toEqual({ left: 180, right: 180 });
  expect(withSlider({ left: 150, right: 160 }, "left", 180)).toEqual({ left: 180, right: 160 });
});
