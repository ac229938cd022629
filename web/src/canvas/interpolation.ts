import type { Frame } from "../api/frames";
import type { Json, Setting } from "../api/protocol";
import { tableOf } from "../shared/world";

/** Frames that come in turn come so far apart; closer ones are drawn as they come. */
const [least_ms, most_ms] = [45, 1500];
const slack = 1.5;

/** How far robots can come, in the unit of the world: what is farther from where it was has jumped, as from edge to edge of a world. */
export interface Reach {
  /** A second. */
  speed: number;
  most: number;
}

/**
 * Robots on their way from one frame to the next: drawn late by as long as a frame takes to come, between what
 * has been told and never beyond it. The next frame is set out for from wherever they are drawn by then.
 */
export class Motion {
  private to: Frame | null = null;
  private from = new Float32Array(0);
  private fromTime_s = 0;
  /** Of the moment that robots have come to last: what lies over them until they come to the next. */
  private overlay: Frame["overlay"];
  private drawn: Frame | null = null;
  private came_ms = 0;
  private lasts_ms = 0;

  /** A frame has come. */
  put(frame: Frame, now_ms: number, reach: Reach): void {
    const { drawn } = this;
    const apart_ms = now_ms - this.came_ms;
    const isNext = drawn?.generation === frame.generation && drawn.count === frame.count;
    const isInTurn = isNext && frame.time_s > drawn.time_s && apart_ms >= least_ms && apart_ms <= most_ms;
    this.lasts_ms = isInTurn ? apart_ms : 0;
    if (isInTurn) this.setOut(drawn, frame, reach);
    this.overlay = this.to?.overlay;
    this.to = frame;
    this.came_ms = now_ms;
  }

  /** What is to be drawn; if nothing `moves`, where all robots have been told to be. */
  at(now_ms: number, moves: boolean): Frame | null {
    const part = this.lasts_ms > 0 ? (now_ms - this.came_ms) / this.lasts_ms : 1;
    if (!moves || part >= 1) this.lasts_ms = 0;
    this.drawn = this.lasts_ms > 0 && this.to ? this.between(this.to, Math.max(0, part)) : this.to;
    return this.drawn;
  }

  /** Whether what is to be drawn will be another thing soon, even if nothing comes. */
  get isUnderWay(): boolean {
    return this.lasts_ms > 0;
  }

  /** Robots set out from where they are drawn; those that jumped are there at once. */
  private setOut(drawn: Frame, to: Frame, reach: Reach): void {
    const most = Math.min(reach.most, slack * reach.speed * (to.time_s - drawn.time_s));
    const from = drawn.robots.slice();
    for (let i = 0; i < from.length; i += 4) {
      const [x, y] = [(to.robots[i] ?? 0) - (from[i] ?? 0), (to.robots[i + 1] ?? 0) - (from[i + 1] ?? 0)];
      if (x * x + y * y > most * most) from.set(to.robots.subarray(i, i + 4), i);
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

/** The shortest way to turn by so much. */
function turn(angle_rad: number): number {
  return angle_rad - 2 * Math.PI * Math.round(angle_rad / (2 * Math.PI));
}

const reaches = new WeakMap<Setting, Reach>();

export function reachOf(setting: Setting): Reach {
  const found = reaches.get(setting) ?? {
    speed: Math.max(0, ...Object.values(tableOf(setting.document.robots)).map(speedOf_m_s)),
    most: Math.min(...setting.world.size) / 2,
  };
  reaches.set(setting, found);
  return found;
}

function speedOf_m_s(kind: Json): number {
  const { max_speed_m_s } = tableOf(tableOf(kind).drive);
  return typeof max_speed_m_s === "number" ? max_speed_m_s : Number.POSITIVE_INFINITY;
}
