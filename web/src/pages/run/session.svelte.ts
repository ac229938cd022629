import { Connection, type Listener, type Transport } from "../../api/connection";
import type { Frame } from "../../api/frames";
import type { ServerMessage } from "../../api/protocol";
import type {
  Change,
  PageMessage,
  Ended,
  EventRow,
  EventsAnswer,
  Json,
  MapPart,
  Opened,
  RecordingEntry,
  Refused,
  Saving,
  SeriesAnswer,
  Setting,
  SignalsAnswer,
  Shown,
  ShowRequest,
  Speed,
  State,
} from "../../api/protocol";
import { FrameQueue } from "../../canvas/frame_queue";
import { BelievedMap } from "../../shared/believed_map";
import type { Link } from "../../shared/link";
import { Throttle } from "../../shared/throttle";
import { type Samples, noSamples, withSamples } from "./charts/samples";
import { Exports } from "./exports";
import { lostPhase, type Phase } from "./phase";
import { SentChanges } from "./sent_changes";
import { Series } from "./series";
import { withArrived } from "./timeline/events";

/** The run of an address, with its text unpacked. */
export type Source = Omit<Link, "text" | "view"> & { text: string | null };

/** A change that has not been sent yet. */
interface PendingChange {
  value: Json;
  /** Whether it replaces the previous change of this path, if the run has not advanced since. */
  replaces_last: boolean;
}

const changes_ms = 50;
/** Numbers that change more often are hard to read, and each update lays out the page again. */
const text_ms = 180;
const states_ms = 180;

/** A run on the page, and the commands to it. */
export class Session implements Listener {
  phase = $state.raw<Phase>({ name: "opening" });
  opened = $state.raw<Opened | null>(null);
  setting = $state.raw<Setting | null>(null);
  state = $state.raw<State | null>(null);
  /** The latest error of each refused change, by path, or of another command, by name. */
  refusals = $state.raw<Record<string, string>>({});
  selected = $state.raw<string | null>(null);
  /** The believed map of the selected robot. */
  map = $state.raw<BelievedMap | null>(null);
  /** The layers and panels that are requested, once they have arrived. */
  shown = $state.raw<Shown | null>(null);
  /** What is sent with frames. */
  request = $state.raw<ShowRequest | null>(null);
  /** Progress of the recording that is being saved. */
  saving = $state.raw<Pick<Saving, "done" | "steps"> | null>(null);
  /** The recording that was saved last, and the changes in it. */
  saved = $state.raw<{ recording: RecordingEntry; changes: string } | null>(null);
  /** Changes that were made while the server was away, by path: they are sent when it is back. */
  unsent = $state.raw<Record<string, PendingChange>>({});
  /** Paths of changes that were sent before the connection was lost, and not confirmed: they are lost. */
  lostChanges = $state.raw<string[]>([]);
  /** A change of a run that is over, until the user has decided about it. */
  afterEnd = $state.raw<{ path: string; value: Json } | null>(null);
  /** What has happened in the run, in order. */
  events = $state.raw<EventRow[]>([]);
  /** Kinds with very many events: of how many one is listed. */
  eventsOneOf = $state.raw<Record<string, number>>({});
  /** Incremented when `series` changes. */
  seriesVersion = $state(0);
  /** Incremented when a new frame has been drawn, at most five times per second. */
  drawnVersion = $state(0);
  series = new Series();
  /** The signals that the server has sampled. */
  samples = $state.raw<Samples>(noSamples);

  readonly frames = new FrameQueue((frame) => this.send({ type: "acknowledge", frame }));
  /** Called when there is something new to draw. */
  onFrame = () => {};

  private readonly connection: Connection;
  private readonly changes = new Throttle<PendingChange>(
    changes_ms,
    (path, put) => this.sendChange(path, put),
    (passed, latest) => ({ ...latest, replaces_last: passed.replaces_last }),
  );
  private drawnAt_ms = 0;
  private stateAt_ms = 0;
  private savedChanges = "";
  private readonly sentChanges = new SentChanges();
  private readonly exports = new Exports();
  /** The signals that it is to sample. */
  private charted: string[] = [];
  /** Whether the answer to a request for the series has yet to arrive. */
  private awaitsSeries = false;

  constructor(
    private readonly source: Source,
    transport?: Transport,
  ) {
    this.connection = new Connection(this, transport);
    this.selected = source.robot;
  }

  start(): void {
    this.connection.start();
  }

  close(): void {
    this.connection.close();
  }

  /** Reopens an ended run. */
  reopen(): void {
    this.phase = { name: "opening" };
    this.start();
  }

  /** The text of the scenario, if it is not one of the server's. */
  get text(): string | null {
    return this.source.text;
  }

  /** The tick that is displayed, or that the run is computing towards. */
  get tick(): number {
    return this.state?.target_tick ?? this.state?.tick ?? this.source.tick;
  }

  /** Whether the run is playing or computing towards a tick. */
  get isAdvancing(): boolean {
    return this.state !== null && (this.state.is_playing || this.state.target_tick !== null);
  }

  /** The classic engine has robots of its own and a world that cannot be edited. */
  get isClassic(): boolean {
    return this.opened?.scenario.engine === "classic";
  }

  /** Whether real robots drive it: it can be neither moved nor changed. */
  get isLive(): boolean {
    return this.source.live;
  }

  // Commands.

  play(speed: Speed): void {
    this.control({ type: "play", speed });
  }

  pause(): void {
    this.control({ type: "pause" });
  }

  step(steps: number): void {
    this.control({ type: "step", steps });
  }

  go(tick: number): void {
    this.control({ type: "seek", tick });
  }

  /**
   * Changes the scenario; `replaces_last` replaces the previous value of the same drag. A change of a run that is
   * over would have no effect: the user decides about it.
   */
  change(path: string, value: Json, replaces_last = false): void {
    if (this.isLive) return;
    if (this.state?.is_over && this.state.tick > 0) this.afterEnd = { path, value };
    else this.changes.put(path, { value, replaces_last });
  }

  /** Goes back to the step before the end, and makes the change there. */
  changeBeforeEnd(): void {
    const change = this.afterEnd;
    this.afterEnd = null;
    if (!change || !this.state) return;
    this.go(this.state.tick - 1);
    this.changes.put(change.path, { value: change.value, replaces_last: false });
  }

  undo(): void {
    this.sentChanges.forget();
    this.control({ type: "undo" });
  }

  redo(): void {
    this.sentChanges.forget();
    this.control({ type: "redo" });
  }

  /** Displays a version of the run that changes have made. */
  chooseVersion(version: number): void {
    this.sentChanges.forget();
    this.control({ type: "choose_version", version });
  }

  /** Saves a recording of the run, unless one is being saved. */
  save(): void {
    if (this.saving) return;
    this.saving = { done: 0, steps: 0 };
    this.savedChanges = this.changesKey;
    this.send({ type: "save" });
  }

  cancelSaving(): void {
    this.send({ type: "cancel_save" });
  }

  /** Identifies the changes of this run. */
  get changesKey(): string {
    return JSON.stringify(this.setting?.log ?? null);
  }

  /** The scenario with all changes, as TOML; null if it could not be exported, which is then among `refusals`. */
  exported(): Promise<string | null> {
    return this.exports
      .next(() => this.phase.name === "open" && this.send({ type: "export" }))
      .catch((error: Error) => {
        this.refusals = { ...this.refusals, export: error.message };
        return null;
      });
  }

  select(robot: string | null): void {
    this.selected = robot;
    this.map = null;
    this.send({ type: "select", robot });
  }

  /** Requests what is sent with frames from now on. */
  show(request: ShowRequest): void {
    this.request = request;
    this.shown = this.shown && requested(this.shown, request);
    this.send({ type: "show", ...request });
  }

  /** Samples these signals from now on. */
  chart(signals: string[]): void {
    this.charted = signals;
    this.send({ type: "chart", signals });
  }

  /** Steps of the run that have not been sampled. */
  get unsampled(): number {
    return Math.max(0, (this.state?.latest_tick ?? 0) - Math.max(0, this.samples.until));
  }

  // Events of the connection.

  ready(): void {
    this.frames.clear();
    if (this.request) this.show(this.request);
    if (this.charted.length > 0) this.chart(this.charted);
    this.send(this.opening());
  }

  lost(retry_ms: number): void {
    const phase = lostPhase(this.phase, this.isLive ? null : this.state, retry_ms);
    this.lostChanges = [...this.lostChanges, ...this.sentChanges.takeUnconfirmed()];
    this.awaitsSeries = false;
    this.exports.fail();
    if (!phase) {
      this.connection.close();
      return;
    }
    this.saving = null;
    this.phase = phase;
  }

  frame(frame: Frame): void {
    this.frames.put(frame);
    this.onFrame();
  }

  message(message: ServerMessage): void {
    if (message.type === "opened") this.receiveOpened(message);
    else if (message.type === "setting") this.receiveSetting(message);
    else if (message.type === "state") this.receiveState(message);
    else if (message.type === "map") this.receiveMap(message);
    else if (message.type === "shown") this.receiveShown(message);
    else if (message.type === "refused") this.receiveRefusal(message);
    else if (message.type === "saving") this.saving = message;
    else if (message.type === "saved") this.receiveSaved(message.recording);
    else if (message.type === "exported") this.exports.received(message.text);
    else if (message.type === "series") this.receiveSeries(message);
    else if (message.type === "events") this.receiveEvents(message);
    else if (message.type === "signals") this.receiveSignals(message);
    else if (message.type === "ended") this.receiveEnd(message);
  }

  /** The latest frame has been drawn. */
  drew(): void {
    const now = performance.now();
    if (this.state?.is_playing && now - this.drawnAt_ms < text_ms) return;
    this.drawnAt_ms = now;
    this.drawnVersion += 1;
  }

  private receiveOpened(opened: Opened): void {
    const { phase } = this;
    this.opened = opened;
    this.phase = { name: "open" };
    this.map = null;
    this.shown = null;
    this.awaitsSeries = false;
    if (this.selected !== null) this.send({ type: "select", robot: this.selected });
    const unsent = Object.entries(this.unsent);
    this.unsent = {};
    for (const [path, change] of unsent) this.sendChange(path, change);
    if (phase.name === "lost" && phase.resumeSpeed !== undefined) this.play(phase.resumeSpeed);
  }

  private receiveSetting(setting: Setting): void {
    this.series.renew(setting.step_s);
    this.setting = setting;
    this.sentChanges.confirm(setting);
    this.refusals = {};
    this.onFrame();
  }

  private receiveState(state: State): void {
    const now = performance.now();
    // While playing, the next state follows soon; starts and stops are displayed at once.
    if (state.is_playing && this.state?.is_playing && now - this.stateAt_ms < states_ms) return;
    this.stateAt_ms = now;
    this.state = state;
    this.series.setPresent(state);
    this.seriesVersion += 1;
    this.requestSeries();
  }

  private requestSeries(): void {
    if (this.awaitsSeries) return;
    this.awaitsSeries = this.send({ type: "request_series", since: this.series.since });
  }

  private receiveSeries(answer: SeriesAnswer): void {
    this.awaitsSeries = false;
    if (this.series.add(answer)) this.seriesVersion += 1;
    else this.requestSeries();
  }

  private receiveEvents(answer: EventsAnswer): void {
    this.events = withArrived(this.events, answer);
    this.eventsOneOf = answer.one_of;
  }

  private receiveSignals(answer: SignalsAnswer): void {
    this.samples = withSamples(this.samples, answer);
  }

  private receiveMap(part: MapPart): void {
    if (part.robot !== this.selected) return;
    this.map = BelievedMap.with(this.map, part);
    this.onFrame();
  }

  private receiveShown(shown: Shown): void {
    // It may have been sent before the server had received what is requested now.
    if (this.request) this.shown = requested(shown, this.request);
    this.onFrame();
  }

  private receiveSaved(recording: RecordingEntry | null): void {
    this.saving = null;
    if (recording) this.saved = { recording, changes: this.savedChanges };
  }

  private receiveRefusal({ about, path, errors, total }: Refused): void {
    const text = errors.map((error) => error.message).join(" ");
    if (about === "change") this.sentChanges.forget(path);
    if (about === "save") this.saving = null;
    if (about === "export") this.exports.fail(text);
    if (about === "open") {
      this.phase = { name: "refused", errors, total };
      this.connection.close();
      return;
    }
    this.refusals = { ...this.refusals, [path ?? about]: text };
  }

  private receiveEnd(ended: Ended): void {
    this.phase = { name: "ended", ended };
    this.exports.fail();
    this.connection.close();
  }

  /** Opens the run at its current state, so that it continues after reconnecting. */
  private opening(): PageMessage {
    if (this.isLive) return { type: "open", live: true };
    const { scenario, text, study, recording, seed, run } = this.source;
    const changes: Change[] | null = this.setting ? this.setting.log : this.source.changes;
    const { tick } = this;
    const seedField = seed === null ? {} : { seed };
    return { type: "open", scenario, text, study, recording, ...seedField, run, changes, tick };
  }

  /** Sends a change, or keeps it until the server is back. */
  private sendChange(path: string, change: PendingChange): void {
    this.lostChanges = this.lostChanges.filter((lost) => lost !== path);
    if (this.phase.name !== "lost" && this.send({ type: "change", path, ...change })) {
      this.sentChanges.sent(path, change.value);
      // A value that is set already changes nothing, and no setting follows.
      if (this.setting) this.sentChanges.confirm(this.setting);
      return;
    }
    this.unsent = { ...this.unsent, [path]: { ...change, replaces_last: false } };
  }

  /** Sends a command that moves or changes the run. */
  private control(command: PageMessage): void {
    if (!this.isLive) this.send(command);
  }

  private send(command: PageMessage): boolean {
    return this.connection.send(command);
  }
}

/** The layers and panels that are requested. */
function requested(shown: Shown, { layers, panels }: ShowRequest): Shown {
  const of = <T>(all: Record<string, T>, names: string[]) =>
    Object.fromEntries(Object.entries(all).filter(([name]) => names.includes(name)));
  return { ...shown, layers: of(shown.layers, layers), panels: of(shown.panels, panels) };
}
