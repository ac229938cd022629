import type { Session } from "../session.svelte";

/** What a pair needs of a run. */
export type Paired = Pick<Session, "state" | "setting" | "step">;

/** Wall-clock time that a step of playback at the maximum speed is to take. */
const slice_ms = 80;

/**
 * Two runs with one clock: both are moved by the same simulated time, and the next step is taken when both have
 * arrived. Neither is ever ahead of the other on the screen, whatever their speeds.
 */
export class Pair {
  isPlaying = $state(false);
  /** Playback speed; null for the maximum. */
  speed = $state<number | null>(1);
  private readonly runs: readonly Paired[];
  /** The tick that each run was sent to; null if it was sent nowhere. */
  private readonly targets: (number | null)[] = [null, null];
  private last_ms = 0;
  /** Simulated time that playback is behind. */
  private owed_s = 0;
  /** Simulated time of a step at the maximum speed. */
  private slice_s = 0;

  constructor(left: Paired, right: Paired) {
    this.runs = [left, right];
  }

  /** The simulated time of both; the later one where a run is over. */
  get time_s(): number {
    return Math.max(...this.runs.map((run) => run.state?.time_s ?? 0));
  }

  /** The last time that one of them has reached. */
  get latest_s(): number {
    return Math.max(...this.runs.map((run) => (run.state?.latest_tick ?? 0) * step_s(run)));
  }

  get isReady(): boolean {
    return this.runs.every((run) => run.state !== null && run.setting !== null);
  }

  get isOver(): boolean {
    return this.isReady && this.runs.every((run) => run.state?.is_over === true);
  }

  /** Whether both are where they were sent; a run that is over cannot go further. */
  get hasArrived(): boolean {
    return this.runs.every((run, i) => {
      const [target, state] = [this.targets[i] ?? null, run.state];
      if (state === null || state.target_tick !== null) return false;
      return target === null || state.tick === target || (state.is_over && state.tick < target);
    });
  }

  play(now_ms: number): void {
    if (this.isOver) return;
    this.isPlaying = true;
    [this.last_ms, this.owed_s] = [now_ms, 0];
    this.slice_s = Math.max(...this.runs.map(step_s));
  }

  pause(): void {
    this.isPlaying = false;
  }

  toggle(now_ms: number): void {
    if (this.isPlaying) this.pause();
    else this.play(now_ms);
  }

  /** Moves both to a time. */
  go(time_s: number): void {
    this.pause();
    this.send(time_s);
  }

  /** Moves both by a number of steps of the one with the longer steps. */
  step(steps: number): void {
    this.go(Math.max(0, this.time_s + steps * Math.max(...this.runs.map(step_s))));
  }

  /** Continues playback; called at each animation frame. */
  advance(now_ms: number): void {
    const passed_ms = now_ms - this.last_ms;
    if (!this.isPlaying || !this.isReady || !this.hasArrived) return;
    if (this.isOver) {
      this.pause();
      return;
    }
    this.last_ms = now_ms;
    if (this.speed === null) {
      this.slice_s *= Math.min(2, Math.max(0.5, slice_ms / Math.max(1, passed_ms)));
      this.slice_s = Math.max(this.slice_s, ...this.runs.map(step_s));
      this.send(this.time_s + this.slice_s);
      return;
    }
    // A run that takes longer than real time is not to catch up later.
    this.owed_s += (Math.min(passed_ms, 500) / 1000) * this.speed;
    const next_s = this.time_s + this.owed_s;
    if (this.runs.some((run) => tickAt(run, next_s) > (run.state?.tick ?? 0) && !run.state?.is_over)) {
      this.owed_s = 0;
      this.send(next_s);
    }
  }

  private send(time_s: number): void {
    this.runs.forEach((run, i) => {
      const tick = tickAt(run, time_s);
      const { state } = run;
      if (!state || (state.is_over && tick >= state.tick)) return;
      this.targets[i] = tick;
      // Unlike `go`, steps continue beyond the latest tick.
      if (tick !== state.tick) run.step(tick - (state.target_tick ?? state.tick));
    });
  }
}

function step_s(run: Paired): number {
  return run.setting?.step_s ?? 1;
}

function tickAt(run: Paired, time_s: number): number {
  return Math.max(0, Math.round(time_s / step_s(run) + 1e-9));
}
