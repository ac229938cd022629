import { afterEach, beforeEach, describe, expect, test, vi } from "vitest";
import type { Answer, WardenState } from "../../api/warden";
import { type Connection, type ConnectionEvent, next } from "./connection";
import { Poller } from "./poller";

const stateAt = (time_s: number) => ({ time_s }) as WardenState;
const answered = (time_s: number, sent_ms: number): ConnectionEvent => ({
  type: "answered",
  state: stateAt(time_s),
  sent_ms,
});
const tick = (at_ms: number): ConnectionEvent => ({ type: "tick", at_ms });
const after = (...events: ConnectionEvent[]) =>
  events.reduce<Connection>(next, { phase: "connecting" }).phase;

describe("the connection", () => {
  test("is connecting until the first answer", () => {
    expect(after(tick(10_000))).toBe("connecting");
    expect(after(answered(1, 0))).toBe("connected");
  });

  test("is stale 0.5 s after the request for its newest state, and lost after 3 s", () => {
    expect(after(answered(1, 0), tick(500))).toBe("connected");
    expect(after(answered(1, 0), tick(501))).toBe("stale");
    expect(after(answered(1, 0), tick(501), tick(3001))).toBe("lost");
    expect(after(answered(1, 0), tick(501), answered(2, 600))).toBe("connected");
  });

  test("is stale if the warden answers but its time does not advance", () => {
    expect(after(answered(1, 0), answered(1, 400), tick(600))).toBe("stale");
    expect(after(answered(1, 0), tick(600), answered(1, 600))).toBe("stale");
    expect(after(answered(1, 0), tick(3001), answered(1, 3001))).toBe("lost");
  });

  test("is lost at once if the warden cannot be reached, but not by one late answer", () => {
    expect(after(answered(1, 0), { type: "failed", isTimeout: false })).toBe("lost");
    expect(after({ type: "failed", isTimeout: false })).toBe("lost");
    expect(after(answered(1, 0), { type: "failed", isTimeout: true })).toBe("connected");
  });

  test("remains refused until the warden accepts the token", () => {
    const refused: ConnectionEvent = { type: "refused" };
    expect(after(answered(1, 0), refused, tick(9000), { type: "failed", isTimeout: false })).toBe("refused");
    expect(after(refused, answered(1, 0))).toBe("connected");
  });
});

describe("the poller", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  test("requests the state ten times per second", async () => {
    const request = vi.fn(async (): Promise<Answer<WardenState>> => ({
      kind: "answered",
      body: stateAt(1),
    }));
    const poller = new Poller(request, () => undefined);
    poller.start();
    await vi.advanceTimersByTimeAsync(1000);
    poller.stop();
    expect(request).toHaveBeenCalledTimes(11);
  });

  test("has one request in flight, and gives it up after 0.5 s", async () => {
    let [open, maxOpen] = [0, 0];
    const events: ConnectionEvent[] = [];
    const frozen = (signal: AbortSignal) => {
      maxOpen = Math.max(maxOpen, ++open);
      return new Promise<Answer<WardenState>>((done) =>
        signal.addEventListener("abort", () => {
          open -= 1;
          done({ kind: "failed" });
        }),
      );
    };
    const poller = new Poller(frozen, (event) => events.push(event));
    poller.start();
    await vi.advanceTimersByTimeAsync(1150);
    poller.stop();
    expect(maxOpen).toBe(1);
    expect(events.filter(({ type }) => type === "failed")).toEqual([
      { type: "failed", isTimeout: true },
      { type: "failed", isTimeout: true },
    ]);
  });
});
