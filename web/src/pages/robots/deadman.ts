/** Motor values of the tracks: 100 to 200, 150 is neutral. */
export interface Tracks {
  left: number;
  right: number;
}

export const repeat_ms = 100;

/**
 * Sends motor values while a control is held: at once, then every 0.1 s. Nothing is sent after the release, not
 * even a stop: the values expire at the warden, as they would if this page had crashed.
 */
export class Deadman {
  private held: { source: string; tracks: Tracks; controller: AbortController } | null = null;
  private timer: ReturnType<typeof setInterval> | undefined;

  constructor(private readonly send: (tracks: Tracks, signal: AbortSignal) => Promise<void>) {}

  /** The control that is held. */
  get source(): string | null {
    return this.held?.source ?? null;
  }

  /** Begins to send. A control that was held before is released. */
  hold(source: string, tracks: Tracks): void {
    this.release();
    const hold = { source, tracks, controller: new AbortController() };
    this.held = hold;
    let isSending = false;
    const beat = async () => {
      // One request at a time: with more, an old one could arrive after a release.
      if (isSending) return;
      isSending = true;
      await this.send(hold.tracks, hold.controller.signal);
      isSending = false;
    };
    this.timer = setInterval(() => void beat(), repeat_ms);
    void beat();
  }

  /** Changes what is sent from the next time on, if the control is held. */
  change(source: string, tracks: Tracks): void {
    if (this.held?.source === source) this.held.tracks = tracks;
  }

  /** Ends the sending; also of a request in flight. With `source`, only if that control is held. */
  release(source?: string): void {
    if (!this.held || (source !== undefined && source !== this.held.source)) return;
    clearInterval(this.timer);
    this.held.controller.abort();
    this.held = null;
  }
}

/** Calls `release` whenever the user's hold may have ended without an event on the control itself. */
export function onHoldEnd(release: () => void): () => void {
  const ends = ["pointerup", "pointercancel", "lostpointercapture", "blur", "pagehide", "contextmenu"];
  const hidden = () => document.hidden && release();
  for (const name of ends) addEventListener(name, release, { capture: name !== "blur" });
  document.addEventListener("visibilitychange", hidden);
  return () => {
    for (const name of ends) removeEventListener(name, release, { capture: name !== "blur" });
    document.removeEventListener("visibilitychange", hidden);
  };
}
