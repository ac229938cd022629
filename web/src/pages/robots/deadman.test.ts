import { afterEach, beforeEach, describe, expect, test, vi } from "vitest";
import { Deadman, neutral, type Tracks } from "./deadman";

const ahead = { left: 175, right: 175 };
const turn = { left: 125, right: 175 };

describe("the deadman", () => {
  let sent: Tracks[];
  let signals: AbortSignal[];
  let deadman: Deadman;

  beforeEach(() => {
    vi.useFakeTimers();
    [sent, signals] = [[], []];
    deadman = new Deadman(async (tracks, signal) => {
      sent.push(tracks);
      signals.push(signal);
    });
  });
  afterEach(() => vi.useRealTimers());

  test("sends at once and every 0.1 s while a control is held", async () => {
    deadman.hold("forward", ahead);
    expect(sent).toEqual([ahead]);
    await vi.advanceTimersByTimeAsync(1000);
    expect(sent).toHaveLength(11);
  });

  test("sends neutral values at the release, at once, and aborts what is in flight", async () => {
    deadman.hold("forward", ahead);
    await vi.advanceTimersByTimeAsync(250);
    const [, , motion] = signals;
    deadman.release();
    expect(motion?.aborted).toBe(true);
    expect(sent).toEqual([ahead, ahead, ahead, neutral]);
    await vi.advanceTimersByTimeAsync(1000);
    expect(sent.slice(3)).toEqual(Array(11).fill(neutral));
  });

  test("sends nothing once it is closed", async () => {
    deadman.open();
    deadman.hold("forward", ahead);
    await vi.advanceTimersByTimeAsync(250);
    deadman.close();
    expect(signals.every((signal) => signal.aborted)).toBe(true);
    deadman.release();
    const { length } = sent;
    await vi.advanceTimersByTimeAsync(5000);
    expect(sent).toHaveLength(length);
  });

  test("sends what a slider shows, and nothing if it is moved without being held", async () => {
    deadman.change("left", turn);
    await vi.advanceTimersByTimeAsync(500);
    expect(sent).toEqual([]);
    deadman.hold("left", ahead);
    deadman.change("left", turn);
    await vi.advanceTimersByTimeAsync(100);
    expect(sent).toEqual([ahead, turn]);
  });

  test("obeys the newest control only", async () => {
    deadman.hold("forward", ahead);
    deadman.hold("left", turn);
    deadman.release("forward");
    await vi.advanceTimersByTimeAsync(100);
    expect(sent).toEqual([ahead, turn, turn]);
    deadman.release("left");
    expect(deadman.source).toBeNull();
  });

  test("has one request in flight at most", async () => {
    let answer = () => {};
    let count = 0;
    const slow = new Deadman(() => {
      count += 1;
      return new Promise((done) => (answer = done));
    });
    slow.hold("forward", ahead);
    await vi.advanceTimersByTimeAsync(1000);
    expect(count).toBe(1);
    answer();
    await vi.advanceTimersByTimeAsync(100);
    expect(count).toBe(2);
  });
});
