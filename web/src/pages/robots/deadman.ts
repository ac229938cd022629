/** Motor values of the tracks: 100 to 200, 150 is neutral. */
export interface Tracks {
  left: number;
  right: number;
}

export const neutral: Tracks = { left: 150, right: 150 };
export const isNeutral = ({ left, right }: Tracks) => left === neutral.left && right === neutral.right;
export const repeat_ms = 100;

/**
 * Sends motor values every 0.1 s while manual control is open: those of the control that is held, at once when it
 * is pressed, and neutral ones while none is held. After `close`, nothing is sent: the values expire at the
 * warden, as they would if this page had crashed.
 */
export class Deadman {
  private held: { source: string; tracks: Tracks } | null = null;
  private inFlight = new AbortController();
  private timer: ReturnType<typeof setInterval> | undefined;

  constructor(private readonly send: (tracks: Tracks, signal: AbortSignal) => Promise<void>) {}

  /** The control that is held. */
  get source(): string | null {
    return this.held?.source ?? null;
  }

  open(): void {
    if (this.timer === undefined) this.restart();
  }

  close(): void {
    clearInterval(this.timer);
    this.timer = undefined;
    this.held = null;
    this.inFlight.abort();
  }

  /** Sends the values of a control from now on. A control that was held before is released. */
  hold(source: string, tracks: Tracks): void {
    this.held = { source, tracks };
    this.restart();
  }

  /** Changes what is sent from the next time on, if the control is held. */
  change(source: string, tracks: Tracks): void {
    if (this.held?.source === source) this.held.tracks = tracks;
  }

  /** Sends neutral values from now on. With `source`, only if that control is held. */
  release(source?: string): void {
    if (!this.held || (source !== undefined && source !== this.held.source)) return;
    this.held = null;
    this.restart();
  }

  private restart(): void {
    clearInterval(this.timer);
    this.inFlight.abort();
    const { signal } = (this.inFlight = new AbortController());
    let isSending = false;
    const beat = async () => {
      // One request at a time: with more, an old one could arrive after a newer one.
      if (isSending) return;
      isSending = true;
      await this.send(this.held?.tracks ?? neutral, signal);
      isSending = false;
    };
    this.timer = setInterval(() => void beat(), repeat_ms);
    void beat();
  }
}

/** Calls `release` whenever the user's hold may have ended without an event on the control itself. */
export function onHoldEnd(release: () => void): () => void {
  const ends = ["pointerup", "pointercancel", "lostpointercapture", "blur", "pagehide"];
  const hidden = () => document.hidden && release();
  const menu = (event: Event) => {
    // A long press on a touch screen opens no menu on a control; another menu may hide the release.
    if (event.target instanceof Element && event.target.closest("[data-hold]")) event.preventDefault();
    else release();
  };
  addEventListener("contextmenu", menu, { capture: true });
  for (const name of ends) addEventListener(name, release, { capture: name !== "blur" });
  document.addEventListener("visibilitychange", hidden);
  return () => {
    for (const name of ends) removeEventListener(name, release, { capture: name !== "blur" });
    removeEventListener("contextmenu", menu, { capture: true });
    document.removeEventListener("visibilitychange", hidden);
  };
}
