import type { Frame } from "../../api/frames";

/** With more robots than this, only the selected one leaves a trail. */
const maxRobots = 300;
const samples = 48;
const span_s = 12;

interface Sample {
  time_s: number;
  /** x and y of each robot. */
  places: Float32Array;
}

/** Robot positions of the last seconds, in a ring buffer of samples. */
export class Trails {
  private readonly ring: Sample[] = [];
  private next = 0;
  private robots = -1;
  /** The only robot with a trail; -1: all robots. */
  only = -1;

  put(frame: Frame, selected: number): void {
    const only = frame.count > maxRobots ? selected : -1;
    const kept = frame.count > maxRobots ? Math.min(1, selected + 1) : frame.count;
    if (kept !== this.robots || only !== this.only) this.clear(kept, only);
    const last = this.newest();
    if (last && frame.time_s < last.time_s) this.clear(kept, only);
    else if (last && frame.time_s < last.time_s + span_s / samples) return;
    if (kept > 0) this.write(frame);
  }

  /** From the oldest to the newest. */
  inOrder(): Sample[] {
    const newest_s = this.newest()?.time_s ?? 0;
    const all = [...this.ring.slice(this.next), ...this.ring.slice(0, this.next)];
    return all.filter(({ time_s }) => time_s >= newest_s - span_s);
  }

  get isEmpty(): boolean {
    return this.ring.length < 2;
  }

  private clear(robots: number, only: number): void {
    this.ring.length = 0;
    this.next = 0;
    [this.robots, this.only] = [robots, only];
  }

  private newest(): Sample | undefined {
    return this.ring[(this.next + this.ring.length - 1) % this.ring.length];
  }

  private write({ time_s, robots }: Frame): void {
    const sample = this.ring[this.next] ?? { time_s, places: new Float32Array(2 * this.robots) };
    const first = Math.max(0, this.only);
    for (let i = 0; i < this.robots; i++) {
      sample.places[2 * i] = robots[4 * (first + i)] ?? 0;
      sample.places[2 * i + 1] = robots[4 * (first + i) + 1] ?? 0;
    }
    sample.time_s = time_s;
    this.ring[this.next] = sample;
    this.next = (this.next + 1) % samples;
  }
}
