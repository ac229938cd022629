import { expect, test } from "vitest";
import { describe, type StopView } from "./emergency_stop";

const view: StopView = {
  request: "none",
  failures: 0,
  isReachable: true,
  isLatched: false,
  robots: [{ name: "bender/0", unseen: null }],
};

test("a stop is confirmed only by the standstill of each robot", () => {
  expect(describe({ ...view, request: "requested" })).toBe("Stop requested, not confirmed.");
  expect(describe({ ...view, request: "accepted", isLatched: true })).toContain("standstill not confirmed");
  const robots = [{ name: "bender/0", unseen: { speed_m_s: 0.2149 } }];
  expect(describe({ ...view, request: "accepted", isLatched: true, robots })).toBe(
    "Stop is latched. bender/0: standstill confirmed (slower than 0.22 m/s)",
  );
});

test("nothing is confirmed while the warden does not respond", () => {
  expect(describe({ ...view, request: "requested", failures: 2 })).toContain("not confirmed");
  expect(describe({ ...view, request: "accepted", isReachable: false })).toContain("not confirmed");
});
