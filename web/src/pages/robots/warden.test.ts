import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { WardenRobot, WardenState } from "../../api/warden";
import { WardenSession } from "./warden.svelte";

const origin = { latitude_deg: 0, longitude_deg: 0, rotation_deg: 0, declination_deg: 0 };
const drive = { warden: { port: 1, token: "secret" }, fleet: "bender", origin, robots: {} };
const ahead = { left: 175, right: 175 };
const isAhead = ({ left }: Record<string, unknown>) => left === ahead.left;

let bodies: Record<string, unknown>[];
/** The paths of the requests that only change something once. */
let taken: string[];
/** The time at which the warden's time no longer advances. */
let stuckAt_ms: number;
/** Why the warden refuses motor values; empty if it takes them. */
let refusal: string;
let session: WardenSession;

function state(): WardenState {
  const robot = { name: "bender/0", mode: "manual", is_armed: true } as WardenRobot;
  const time_s = Math.min(performance.now(), stuckAt_ms) / 1000;
  return { time_s, operator: "you", robots: [robot], events: [] } as unknown as WardenState;
}

beforeEach(async () => {
  vi.useFakeTimers();
  [bodies, taken, stuckAt_ms, refusal] = [[], [], Infinity, ""];
  vi.stubGlobal("addEventListener", () => undefined);
  vi.stubGlobal("removeEventListener", () => undefined);
  vi.stubGlobal("document", { addEventListener: () => undefined, removeEventListener: () => undefined });
  vi.stubGlobal("fetch", async (url: string, { body }: { body: string }) => {
    if (url.endsWith("/manual")) bodies.push(JSON.parse(body) as Record<string, unknown>);
    if (url.endsWith("/manual") && refusal)
      return { ok: false, status: 409, json: async () => ({ message: refusal }) };
    const isRepeated = url.endsWith("/operator") && taken.push(url) > 1;
    if (isRepeated) return { ok: false, status: 409, json: async () => ({ message: "already" }) };
    return { ok: true, status: 200, json: async () => state() };
  });
  session = new WardenSession(drive);
  session.start();
  await vi.advanceTimersByTimeAsync(0);
  session.deadman.hold("forward", ahead);
  await vi.advanceTimersByTimeAsync(1000);
});

afterEach(() => {
  session.close();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

test("motion is sent every 0.1 s while states of the warden arrive, with increasing numbers", () => {
  expect(bodies.map(({ number }) => number)).toEqual([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
  expect(bodies.every(isAhead)).toBe(true);
});

test("motion ends within 0.6 s of the newest state, and does not begin again without a press", async () => {
  stuckAt_ms = performance.now();
  await vi.advanceTimersByTimeAsync(600);
  const { length } = bodies;
  await vi.advanceTimersByTimeAsync(5000);
  expect(bodies).toHaveLength(length);
  stuckAt_ms = Infinity;
  await vi.advanceTimersByTimeAsync(1000);
  expect(bodies.slice(length).some(isAhead)).toBe(false);
});

test("a double click is one request, and shows no refusal", async () => {
  const clicks = [session.request("/operator", { take: true }), session.request("/operator", { take: true })];
  await vi.advanceTimersByTimeAsync(0);
  expect(await Promise.all(clicks)).toEqual([true, true]);
  await vi.advanceTimersByTimeAsync(150);
  expect(await session.request("/operator", { take: true })).toBe(true);
  expect(taken).toHaveLength(1);
  expect(session.refusal).toBeNull();
  await vi.advanceTimersByTimeAsync(500);
  expect(await session.request("/operator", { take: true })).toBe(false);
  expect(session.refusal?.text).toContain("already");
});

test("a refusal of a motion is shown and releases the control; one of neutral values is not shown", async () => {
  refusal = "bender/0 is not in manual mode";
  await vi.advanceTimersByTimeAsync(200);
  expect(session.refusal).toEqual({ path: "/manual", text: refusal });
  expect(session.deadman.source).toBeNull();
  session.refusal = null;
  await vi.advanceTimersByTimeAsync(1000);
  expect(session.refusal).toBeNull();
});

test("the refusal of a request remains while neutral values are accepted", async () => {
  session.deadman.release();
  session.refuse("/arm", "no");
  await vi.advanceTimersByTimeAsync(1000);
  expect(session.refusal?.text).toBe("no");
});

test("after a refusal, neutral values are sent again, which a robot needs to be armed, and no motion", async () => {
  refusal = "the drive ends";
  await vi.advanceTimersByTimeAsync(200);
  refusal = "";
  const { length } = bodies;
  await vi.advanceTimersByTimeAsync(1000);
  expect(bodies.slice(length)).toHaveLength(10);
  expect(bodies.slice(length).some(isAhead)).toBe(false);
});

test("a refusal is shown beside its button, or else above the view", () => {
  const session = new WardenSession(drive);
  session.refuse("/arm", "armed already");
  expect(session.unplacedRefusal?.text).toBe("armed already");
  const end = session.place(["/arm", "/resume"]);
  expect(session.unplacedRefusal).toBeNull();
  session.refuse("/hold", "the drive ends");
  expect(session.unplacedRefusal?.text).toBe("the drive ends");
  session.refuse("/arm", "armed already");
  end();
  expect(session.unplacedRefusal?.text).toBe("armed already");
});
