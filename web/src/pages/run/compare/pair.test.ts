import { expect, test } from "vitest";
import type { Setting, State } from "../../../api/protocol";
import { Pair, type Paired } from "./pair.svelte";

/** A run that arrives when the test lets it. */
class Fake implements Paired {
  state: State | null;
  setting: Setting | null;
  sent = 0;
  private target: number | null = null;

  constructor(
    step_s: number,
    private readonly last = 1000,
  ) {
    this.setting = { step_s } as Setting;
    this.state = { tick: 0, latest_tick: 0, time_s: 0, target_tick: null, is_over: false } as State;
  }

  step(steps: number): void {
    this.sent += 1;
    this.target = Math.max(0, (this.state?.tick ?? 0) + steps);
    this.state = { ...this.state, target_tick: this.target } as State;
  }

  arrive(): void {
    if (this.target === null || !this.state || !this.setting) return;
    const tick = Math.min(this.target, this.last);
    const latest_tick = Math.max(tick, this.state.latest_tick);
    const is_over = tick === this.last;
    this.state = { ...this.state, tick, latest_tick, is_over, target_tick: null };
    this.state = { ...this.state, time_s: tick * this.setting.step_s };
    this.target = null;
  }
}

test("the next step is taken when both have arrived", () => {
  const [left, right] = [new Fake(0.1), new Fake(0.1)];
  const pair = new Pair(left, right);
  pair.play(0);
  pair.advance(200);
  expect([left.state?.target_tick, right.state?.target_tick]).toEqual([2, 2]);
  left.arrive();
  pair.advance(400);
  expect([left.sent, right.sent]).toEqual([1, 1]);
  right.arrive();
  pair.advance(600);
  expect([left.state?.target_tick, right.state?.target_tick]).toEqual([6, 6]);
});

test("runs with other steps are at the same time", () => {
  const [left, right] = [new Fake(0.1), new Fake(0.05)];
  const pair = new Pair(left, right);
  pair.go(2);
  left.arrive();
  right.arrive();
  expect([left.state?.tick, right.state?.tick]).toEqual([20, 40]);
  pair.step(1);
  left.arrive();
  right.arrive();
  expect([left.state?.time_s.toFixed(2), right.state?.time_s.toFixed(2)]).toEqual(["2.10", "2.10"]);
});

test("a run that is over stays at its end, and the other one continues to its own", () => {
  const [left, right] = [new Fake(0.1, 10), new Fake(0.1, 30)];
  const pair = new Pair(left, right);
  pair.speed = null;
  pair.play(0);
  for (let now = 0; pair.isPlaying && now < 100_000; now += 20) {
    pair.advance(now);
    left.arrive();
    right.arrive();
  }
  expect([left.state?.tick, right.state?.tick, pair.isPlaying]).toEqual([10, 30, false]);
  expect(pair.time_s).toBe(3);
});

test("going back moves both, also the one that is over", () => {
  const [left, right] = [new Fake(0.1, 10), new Fake(0.1, 30)];
  const pair = new Pair(left, right);
  pair.go(3);
  left.arrive();
  right.arrive();
  pair.go(0.5);
  left.arrive();
  right.arrive();
  expect([left.state?.tick, right.state?.tick]).toEqual([5, 5]);
});
