import { expect, test } from "vitest";
import { withoutPlace } from "./error_text";

test("the message of an error beside its line does not begin with file and line again", () => {
  const message = "my scenario.toml:5: robots.rover.count = -3: must be a whole number";
  expect(withoutPlace({ message, line: 5 })).toBe("robots.rover.count = -3: must be a whole number");
  expect(withoutPlace({ message, line: null })).toBe(message);
  expect(withoutPlace({ message: "merit is missing", line: 5 })).toBe("merit is missing");
});
