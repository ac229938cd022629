import { post, type Unseen, type Warden, type WardenState } from "../api/warden";
import { type Standing, standstills } from "./standstill";

/** What is known of the emergency stop: never more than the warden has confirmed. */
export interface StopView {
  /** `accepted`: the warden has answered the request of this page. */
  request: "none" | "requested" | "accepted";
  /** Number of requests that failed since the stop was requested. */
  failures: number;
  /** Null until the warden has answered or failed to. */
  isReachable: boolean | null;
  /** Whether the stop is latched; also if another page requested it. */
  isLatched: boolean;
  robots: Standing[];
}

const limit_ms = 500;
const pause_ms = 100;
const idle_ms = 1000;
const active_ms = 250;
const name = "emergencystop";

/**
 * The emergency stop of all robots. It depends on nothing of the application: a request goes straight to the
 * warden, outlives the page, and is repeated until the warden has answered it.
 */
export class EmergencyStop {
  private view: StopView = {
    request: "none",
    failures: 0,
    isReachable: null,
    isLatched: false,
    robots: [],
  };
  private accepted_ms = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly client = `stop-${crypto.getRandomValues(new Uint32Array(2)).join("-")}`;

  constructor(
    private readonly warden: Warden,
    private readonly report: (view: StopView) => void,
  ) {}

  /** Requests the stop; while a request is in progress, it is already being repeated. */
  request(): void {
    dispatchEvent(new Event(name));
    if (this.view.request === "requested") return;
    this.show({ request: "requested", failures: 0 });
    void this.attempt();
  }

  /** Follows the warden's state until the page closes. */
  async watch(): Promise<void> {
    clearTimeout(this.timer);
    await this.look();
    const isSettled = !this.view.isLatched || this.view.robots.every(({ unseen }) => unseen);
    const isIdle = this.view.request !== "requested" && this.view.isReachable === true && isSettled;
    this.timer = setTimeout(() => void this.watch(), isIdle ? idle_ms : active_ms);
  }

  private async attempt(): Promise<void> {
    try {
      const response = await post(this.warden, "/stop", {}, { ...within(), keepalive: true });
      if (!response.ok) throw new Error(response.statusText);
      this.accepted_ms = performance.now();
      this.show({ request: "accepted", failures: 0, isReachable: true });
      void this.watch();
    } catch {
      this.show({ failures: this.view.failures + 1, isReachable: false });
      setTimeout(() => void this.attempt(), pause_ms);
    }
  }

  private async look(): Promise<void> {
    const sent_ms = performance.now();
    try {
      const body = { client: this.client, since: Number.MAX_SAFE_INTEGER };
      const response = await post(this.warden, "/state", body, within());
      if (!response.ok) throw new Error(response.statusText);
      this.take((await response.json()) as WardenState, sent_ms);
    } catch {
      // What was true is no longer known.
      const robots = this.view.robots.map(({ name }) => ({ name, unseen: null }));
      this.show({ isReachable: false, robots });
    }
  }

  private take(state: WardenState, sent_ms: number): void {
    // A state from before the stop does not show that the stop has been released.
    const isReleased = !state.is_stopped && sent_ms > this.accepted_ms;
    const isEnded = this.view.request === "accepted" && isReleased;
    this.show({
      isReachable: true,
      isLatched: state.is_stopped,
      robots: state.robots.map((robot) => ({ name: robot.name, unseen: unseenBy(robot) })),
      ...(isEnded ? { request: "none" as const } : {}),
    });
  }

  private show(change: Partial<StopView>): void {
    this.view = { ...this.view, ...change };
    this.report(this.view);
  }
}

/** A standstill counts only while stop is latched, and with the fastest motion that would go unseen. */
function unseenBy({ action, is_standing, unseen }: WardenState["robots"][number]): Unseen | null {
  return action === "latched_stop" && is_standing ? unseen : null;
}

function within(): { signal: AbortSignal } {
  return { signal: AbortSignal.timeout(limit_ms) };
}

/** Calls `action` whenever the emergency stop is requested; returns a function that ends this. */
export function onEmergencyStop(action: () => void): () => void {
  addEventListener(name, action);
  return () => removeEventListener(name, action);
}

/** The state of the stop in words. */
export function describe({ request, failures, isReachable, isLatched, robots }: StopView): string {
  const cut = "Use the switch that cuts the motors.";
  if (request === "requested") {
    return failures > 1
      ? `Stop requested, not confirmed: the warden does not respond. ${cut}`
      : "Stop requested, not confirmed.";
  }
  if (isReachable === null) return "Connecting to the warden.";
  if (!isReachable) return `The warden does not respond. Standstill is not confirmed. ${cut}`;
  if (request === "none" && !isLatched) return "Stops all robots at once.";
  return `${isLatched ? "Stop is latched." : "Stop accepted by the warden."} ${standstills(robots)}`.trim();
}
