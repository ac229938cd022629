import type { Answer, WardenState } from "../../api/warden";
import type { ConnectionEvent } from "./connection";

export const period_ms = 100;
export const limit_ms = 500;

/** Requests the warden's state ten times per second, one request at a time. */
export class Poller {
  private timer: ReturnType<typeof setInterval> | undefined;
  private inFlight: AbortController | null = null;

  constructor(
    private readonly request: (signal: AbortSignal) => Promise<Answer<WardenState>>,
    private readonly handle: (event: ConnectionEvent) => void,
  ) {}

  start(): void {
    this.timer = setInterval(() => this.tick(), period_ms);
    this.tick();
  }

  stop(): void {
    clearInterval(this.timer);
    this.inFlight?.abort();
  }

  private tick(): void {
    this.handle({ type: "tick", at_ms: performance.now() });
    if (!this.inFlight) void this.poll();
  }

  private async poll(): Promise<void> {
    const [sent_ms, controller] = [performance.now(), new AbortController()];
    this.inFlight = controller;
    let isTimeout = false;
    const limit = setTimeout(() => {
      isTimeout = true;
      controller.abort();
    }, limit_ms);
    const answer = await this.request(controller.signal);
    clearTimeout(limit);
    this.inFlight = null;
    if (controller.signal.aborted && !isTimeout) return;
    this.handle(eventOf(answer, sent_ms, isTimeout));
  }
}

export function eventOf(answer: Answer<WardenState>, sent_ms: number, isTimeout: boolean): ConnectionEvent {
  if (answer.kind === "answered") return { type: "answered", state: answer.body, sent_ms };
  return answer.kind === "refused" ? { type: "refused" } : { type: "failed", isTimeout };
}
