import type { Frame } from "../api/frames";

/**
 * Frames that wait to be drawn: only the latest is drawn, and its acknowledgement covers all before it.
 * So a page that draws slowly, or is hidden, receives no more frames than it draws.
 */
export class FrameQueue {
  /** The last frame that was taken. */
  shown: Frame | null = null;
  private waiting: Frame | null = null;

  constructor(private readonly acknowledge: (frame: number) => void) {}

  put(frame: Frame): void {
    this.waiting = frame;
  }

  /** The frame to draw; null if there is none. `drawn` acknowledges it. */
  take(generation: number): Frame | null {
    const frame = this.waiting;
    this.waiting = null;
    if (frame && frame.generation !== generation) this.acknowledge(frame.number);
    else if (frame) this.shown = frame;
    return frame && frame.generation === generation ? frame : null;
  }

  drawn(frame: Frame): void {
    this.acknowledge(frame.number);
  }

  /** Drops the frame of a previous connection. */
  clear(): void {
    this.waiting = null;
  }
}
