import { expect, test } from "vitest";
import { withoutPlace } from "./error_text";

test("the message of an error beside its line does not begin with file and line again", () => {
  const count = "robots.rover.count = -3: must be a whole number";
  expect(withoutPlace(`my scenario.toml:5: ${count}`)).toBe(count);
  expect(withoutPlace("scenario.toml: clock is missing")).toBe("clock is missing");
  expect(withoutPlace(count)).toBe(count);
});
