import type { Frame } from "../api/frames";
import type { Json, Setting } from "../api/protocol";
import { tableOf } from "../shared/world";

/** Interval between frames in which motion is interpolated; other frames are drawn as received. */
const [minInterval_ms, maxInterval_ms] = [45, 1500];
const slack = 1.5;

/** The distance that robots can move. A robot that moved farther has jumped, as across a periodic border. */
export interface MotionLimit {
  /** In units of the world per second. */
  speed: number;
  /** In units of the world. */
  distance: number;
}

/**
 * Interpolates robot poses between frames, one frame interval late and never beyond the latest frame. After
 * each frame, motion continues from the poses that are drawn at that time.
 */
export class Interpolation {
  private to: Frame | null = null;
  private from = new Float32Array(0);
  private fromTime_s = 0;
  /** The overlay of the last frame that was reached; it applies until the next is reached. */
  private overlay: Frame["overlay"];
  private drawn: Frame | null = null;
  private receivedAt_ms = 0;
  private duration_ms = 0;

  /** Adds a frame. */
  put(frame: Frame, now_ms: number, limit: MotionLimit): void {
    const { drawn } = this;
    const interval_ms = now_ms - this.receivedAt_ms;
    const isNext = drawn?.generation === frame.generation && drawn.count === frame.count;
    const isInTurn =
      isNext && frame.time_s > drawn.time_s && interval_ms >= minInterval_ms && interval_ms <= maxInterval_ms;
    this.duration_ms = isInTurn ? interval_ms : 0;
    if (isInTurn) this.start(drawn, frame, limit);
    this.overlay = this.to?.overlay;
    this.to = frame;
    this.receivedAt_ms = now_ms;
  }

  /** The frame to draw; unless `moves`, the latest frame itself. */
  at(now_ms: number, moves: boolean): Frame | null {
    const part = this.duration_ms > 0 ? (now_ms - this.receivedAt_ms) / this.duration_ms : 1;
    if (!moves || part >= 1) this.duration_ms = 0;
    this.drawn = this.duration_ms > 0 && this.to ? this.between(this.to, Math.max(0, part)) : this.to;
    return this.drawn;
  }

  /** Whether the drawn frame changes without a new frame. */
  get isMoving(): boolean {
    return this.duration_ms > 0;
  }

  /** Starts from the drawn poses; robots that jumped are moved at once. */
  private start(drawn: Frame, to: Frame, limit: MotionLimit): void {
    const max = Math.min(limit.distance, slack * limit.speed * (to.time_s - drawn.time_s));
    const from = drawn.robots.slice();
    for (let i = 0; i < from.length; i += 4) {
      const [x, y] = [(to.robots[i] ?? 0) - (from[i] ?? 0), (to.robots[i + 1] ?? 0) - (from[i + 1] ?? 0)];
      if (x * x + y * y > max * max) from.set(to.robots.subarray(i, i + 4), i);
    }
    this.from = from;
    this.fromTime_s = drawn.time_s;
  }

  private between(to: Frame, part: number): Frame {
    const { from, overlay } = this;
    const robots = to.robots.slice();
    for (let i = 0; i < robots.length; i += 4) {
      for (let j = i; j < i + 3; j += 1) {
        const [start = 0, end = 0] = [from[j], robots[j]];
        robots[j] = start + part * (j === i + 2 ? turn(end - start) : end - start);
      }
    }
    return { ...to, robots, overlay, time_s: this.fromTime_s + part * (to.time_s - this.fromTime_s) };
  }
}

/** The equivalent angle in (-pi, pi]. */
function turn(angle_rad: number): number {
  return angle_rad - 2 * Math.PI * Math.round(angle_rad / (2 * Math.PI));
}

const limits = new WeakMap<Setting, MotionLimit>();

export function motionLimitOf(setting: Setting): MotionLimit {
  const found = limits.get(setting) ?? {
    speed: Math.max(0, ...Object.values(tableOf(setting.document.robots)).map(speedOf_m_s)),
    distance: Math.min(...setting.world.size) / 2,
  };
  limits.set(setting, found);
  return found;
}

function speedOf_m_s(kind: Json): number {
  const { max_speed_m_s } = tableOf(tableOf(kind).drive);
  return typeof max_speed_m_s === "number" ? max_speed_m_s : Number.POSITIVE_INFINITY;
}
