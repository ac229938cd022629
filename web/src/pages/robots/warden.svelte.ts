import { SvelteMap } from "svelte/reactivity";
import {
  type Answer,
  ask,
  type Drive,
  post,
  type WardenEvent,
  type WardenRobot,
  type WardenState,
} from "../../api/warden";
import { onEmergencyStop } from "../../shared/emergency_stop";
import { type Connection, type ConnectionEvent, lastOf, next } from "./connection";
import { Deadman, isNeutral, onHoldEnd, type Tracks } from "./deadman";
import { eventOf, Poller } from "./poller";

const maxEvents = 1000;
const limit_ms = 2000;
const manualLimit_ms = 300;
/** A request that is the same as the last one within this time is the second half of a double click. */
const doubleClick_ms = 500;

/** Why a request had no effect. */
export interface Refusal {
  path: string;
  text: string;
}

/** The page's side of the warden: its newest state, and requests. */
export class WardenSession {
  connection = $state.raw<Connection>({ phase: "connecting" });
  events = $state.raw<WardenEvent[]>([]);
  /** Why the last request had no effect; null if it had one. */
  refusal = $state.raw<Refusal | null>(null);
  /** The requests of which a part of the view shows the refusal beside its button. */
  private readonly places = new SvelteMap<symbol, string[]>();
  /** The robot that the controls are for. */
  selected = $state("");
  readonly deadman = new Deadman((tracks, signal) => this.sendTracks(tracks, signal));
  private readonly client = crypto.getRandomValues(new Uint32Array(4)).join("-");
  private readonly poller: Poller;
  private readonly cleanups: (() => void)[] = [];
  private number = 0;
  private last = { key: "", sent_ms: -Infinity, answer: Promise.resolve(false) };

  constructor(readonly drive: Drive) {
    const state = (signal: AbortSignal) =>
      ask<WardenState>(this.drive.warden, "/state", { client: this.client, since: this.since }, signal);
    this.poller = new Poller(state, (event) => this.handle(event));
  }

  start(): void {
    this.poller.start();
    this.cleanups.push(
      onHoldEnd(() => this.deadman.release()),
      onEmergencyStop(() => this.deadman.release()),
    );
  }

  close(): void {
    this.deadman.close();
    for (const end of this.cleanups.splice(0)) end();
    this.poller.stop();
    if (!this.isOperator) return;
    const body = { client: this.client, take: false };
    void post(this.drive.warden, "/operator", body, { keepalive: true }).catch(() => undefined);
  }

  get state(): WardenState | null {
    return lastOf(this.connection)?.state ?? null;
  }

  get robot(): WardenRobot | null {
    const robots = this.state?.robots ?? [];
    return robots.find(({ name }) => name === this.selected) ?? robots[0] ?? null;
  }

  get isFresh(): boolean {
    return this.connection.phase === "connected";
  }

  get isOperator(): boolean {
    return this.state?.operator === "you";
  }

  /** Whether requests of an operator are possible. */
  get hasControl(): boolean {
    return this.isFresh && this.isOperator;
  }

  /** Whether the selected robot takes motor values. It has to receive them before it can be armed. */
  get canSend(): boolean {
    return this.hasControl && this.robot?.mode === "manual";
  }

  /** Whether the selected robot can be driven by hand. */
  get canDrive(): boolean {
    return this.canSend && this.robot?.is_armed === true;
  }

  /** Sends a request of the operator, once for a double click; true if the warden has accepted it. */
  request(path: string, body: object = {}): Promise<boolean> {
    const [key, sent_ms] = [JSON.stringify([path, body]), performance.now()];
    // The warden refuses what changes nothing, such as taking control for a second time.
    if (key !== this.last.key || sent_ms - this.last.sent_ms >= doubleClick_ms) {
      this.last = { key, sent_ms, answer: this.send(path, body) };
    }
    return this.last.answer;
  }

  private async send(path: string, body: object): Promise<boolean> {
    const signal = AbortSignal.timeout(limit_ms);
    const answer = await ask(this.drive.warden, path, { client: this.client, ...body }, signal);
    this.refuse(path, refusalOf(answer));
    return answer.kind === "answered";
  }

  /** Keeps why a request had no effect, until the next one; empty if it had one. */
  refuse(path: string, text: string): void {
    this.refusal = text === "" ? null : { path, text };
  }

  /** Notes that the refusals of some requests are shown beside their button; returns a function that ends this. */
  place(paths: string[]): () => void {
    const key = Symbol();
    this.places.set(key, paths);
    return () => this.places.delete(key);
  }

  /** The refusal that is shown beside no button. */
  get unplacedRefusal(): Refusal | null {
    const { refusal } = this;
    return refusal && ![...this.places.values()].some((paths) => paths.includes(refusal.path))
      ? refusal
      : null;
  }

  /** As `request`, for the selected robot. */
  requestOfRobot(path: string, body: object = {}): Promise<boolean> {
    return this.request(path, { robot: this.robot?.name, ...body });
  }

  private get since(): number {
    return this.events.at(-1)?.number ?? -1;
  }

  private async sendTracks(tracks: Tracks, held: AbortSignal): Promise<void> {
    const [sent_ms, limit] = [performance.now(), AbortSignal.timeout(manualLimit_ms)];
    const body = { client: this.client, robot: this.robot?.name, ...tracks, number: this.number++ };
    const signal = AbortSignal.any([held, limit]);
    const answer = await ask<WardenState>(this.drive.warden, "/manual", body, signal);
    if (held.aborted) return;
    if (answer.kind === "answered") this.handle(eventOf(answer, sent_ms, limit.aborted));
    // No operator has requested neutral values: their answer neither shows a refusal nor hides that of a request.
    if (answer.kind === "failed" || isNeutral(tracks)) return;
    this.refuse("/manual", refusalOf(answer));
    // What is refused must not begin to move the robot when the reason ends.
    if (answer.kind !== "answered") this.deadman.release();
  }

  private handle(event: ConnectionEvent): void {
    const connection = next(this.connection, event);
    if (connection === this.connection) return;
    this.connection = connection;
    if (event.type === "answered") this.keep(event.state);
    if (!this.canSend) this.deadman.close();
    else if (!this.canDrive) this.deadman.release();
  }

  private keep({ events, robots }: WardenState): void {
    const fresh = events.filter(({ number }) => number > this.since);
    if (fresh.length > 0) this.events = [...this.events, ...fresh].slice(-maxEvents);
    if (!robots.some(({ name }) => name === this.selected)) this.selected = robots[0]?.name ?? "";
  }
}

function refusalOf(answer: Answer<unknown>): string {
  switch (answer.kind) {
    case "answered":
      return "";
    case "conflict":
      return answer.message;
    case "refused":
      return "The warden does not accept this page.";
    case "failed":
      return "The warden did not answer. Whether the request had an effect is not known.";
  }
}
