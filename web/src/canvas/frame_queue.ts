import type { Frame } from "../api/frames";

/**
 * Frames on their way to the screen: only the latest is drawn, and its acknowledgement is one of all before it.
 * So a page that draws slowly, or is not seen, is sent no more than it draws.
 */
export class FrameQueue {
  /** The last one that was taken to be drawn. */
  shown: Frame | null = null;
  private waiting: Frame | null = null;

  constructor(private readonly acknowledge: (frame: number) => void) {}

  put(frame: Frame): void {
    this.waiting = frame;
  }

  /** The frame to draw now; null if there is nothing new. It is acknowledged by `drawn`. */
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

  /** Forgets what was of another line. */
  clear(): void {
    this.waiting = null;
  }
}
