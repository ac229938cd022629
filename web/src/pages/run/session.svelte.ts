import { Connection, type Listener } from "../../api/connection";
import type { Frame } from "../../api/frames";
import type { ServerMessage } from "../../api/protocol";
import type {
  Change,
  PageMessage,
  Ended,
  InputError,
  Json,
  MapPart,
  Opened,
  OverlayRequest,
  RecordingEntry,
  Refused,
  Saving,
  Setting,
  Speed,
  State,
} from "../../api/protocol";
import { FrameQueue } from "../../canvas/frame_queue";
import { BelievedMap } from "../../shared/believed_map";
import type { Link } from "../../shared/link";
import { Series } from "./series";
import { Throttle } from "../../shared/throttle";

/** `opening` until the server confirms the run; `lost` while reconnecting. */
export type Phase = "opening" | "open" | "lost" | "refused" | "ended";

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
  phase = $state<Phase>("opening");
  opened = $state.raw<Opened | null>(null);
  setting = $state.raw<Setting | null>(null);
  state = $state.raw<State | null>(null);
  /** Why the run could not be opened. */
  errors = $state.raw<InputError[]>([]);
  ended = $state.raw<Ended | null>(null);
  /** The latest error of each refused change, by path, or of another command, by name. */
  refusals = $state.raw<Record<string, string>>({});
  selected = $state.raw<string | null>(null);
  /** The believed map of the selected robot. */
  map = $state.raw<BelievedMap | null>(null);
  /** The overlays that frames come with. */
  overlays = $state.raw<OverlayRequest | null>(null);
  /** Progress of the recording that is being saved. */
  saving = $state.raw<Pick<Saving, "done" | "steps"> | null>(null);
  /** The recording that was saved last, and the changes in it. */
  saved = $state.raw<{ recording: RecordingEntry; changes: string } | null>(null);
  /** Milliseconds until the next attempt to connect. */
  retry_ms = $state(0);
  /** Incremented when `series` changes. */
  seriesVersion = $state(0);
  /** Incremented when a new frame has been drawn, at most five times per second. */
  drawnVersion = $state(0);
  series = new Series();

  readonly frames = new FrameQueue((frame) => this.send({ type: "acknowledge", frame }));
  /** Called when there is something new to draw. */
  onFrame = () => {};

  private readonly connection = new Connection(this);
  private readonly changes = new Throttle<PendingChange>(
    changes_ms,
    (path, put) => this.send({ type: "change", path, ...put }),
    (passed, latest) => ({ ...latest, replaces_last: passed.replaces_last }),
  );
  private drawnAt_ms = 0;
  private stateAt_ms = 0;
  private savedChanges = "";
  private resolveExport: ((text: string) => void) | null = null;
  /** Speed to continue with after reconnecting; undefined if the run was paused. */
  private resumeSpeed: Speed | undefined;

  constructor(private readonly source: Source) {
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
    this.phase = "opening";
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

  // Commands.

  play(speed: Speed): void {
    this.send({ type: "play", speed });
  }

  pause(): void {
    this.send({ type: "pause" });
  }

  step(steps: number): void {
    this.send({ type: "step", steps });
  }

  go(tick: number): void {
    this.send({ type: "seek", tick });
  }

  /** Changes the scenario; `replaces_last` replaces the previous value of the same drag. */
  change(path: string, value: Json, replaces_last = false): void {
    this.changes.put(path, { value, replaces_last });
  }

  undo(): void {
    this.send({ type: "undo" });
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

  /** The scenario with all changes, as TOML. */
  exported(): Promise<string> {
    this.send({ type: "export" });
    return new Promise((resolve) => {
      this.resolveExport = resolve;
    });
  }

  select(robot: string | null): void {
    this.selected = robot;
    this.map = null;
    this.send({ type: "select", robot });
  }

  /** Requests the overlays that frames come with from now on. */
  requestOverlays(overlays: OverlayRequest): void {
    this.overlays = overlays;
    this.send({ type: "layers", ...overlays });
  }

  // Events of the connection.

  ready(): void {
    this.frames.clear();
    if (this.overlays) this.requestOverlays(this.overlays);
    this.send(this.opening());
  }

  lost(retry_ms: number): void {
    if (this.phase === "ended" || this.phase === "refused") {
      this.connection.close();
      return;
    }
    this.saving = null;
    if (this.phase === "open") this.resumeSpeed = this.state?.is_playing ? this.state.speed : undefined;
    this.phase = "lost";
    this.retry_ms = retry_ms;
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
    else if (message.type === "refused") this.receiveRefusal(message);
    else if (message.type === "saving") this.saving = message;
    else if (message.type === "saved") this.receiveSaved(message.recording);
    else if (message.type === "exported") this.resolveExport?.(message.text);
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
    this.opened = opened;
    this.phase = "open";
    this.map = null;
    if (this.selected !== null) this.send({ type: "select", robot: this.selected });
    if (this.resumeSpeed !== undefined) this.play(this.resumeSpeed);
    this.resumeSpeed = undefined;
  }

  private receiveSetting(setting: Setting): void {
    if (this.setting && this.setting.step_s !== setting.step_s) this.series.setStep(setting.step_s);
    this.setting = setting;
    this.refusals = {};
    this.onFrame();
  }

  private receiveState(state: State): void {
    this.series.add(state);
    const now = performance.now();
    // While playing, the next state follows soon; starts and stops are displayed at once.
    if (state.is_playing && this.state?.is_playing && now - this.stateAt_ms < states_ms) return;
    this.stateAt_ms = now;
    this.state = state;
    this.seriesVersion += 1;
  }

  private receiveMap(part: MapPart): void {
    if (part.robot !== this.selected) return;
    this.map = BelievedMap.with(this.map, part);
    this.onFrame();
  }

  private receiveSaved(recording: RecordingEntry | null): void {
    this.saving = null;
    if (recording) this.saved = { recording, changes: this.savedChanges };
  }

  private receiveRefusal({ about, path, errors }: Refused): void {
    if (about === "save") this.saving = null;
    if (about === "open") {
      this.errors = errors;
      this.phase = "refused";
      this.connection.close();
      return;
    }
    const text = errors.map((error) => error.message).join(" ");
    this.refusals = { ...this.refusals, [path ?? about]: text };
  }

  private receiveEnd(ended: Ended): void {
    this.ended = ended;
    this.phase = "ended";
    this.connection.close();
  }

  /** Opens the run at its current state, so that it continues after reconnecting. */
  private opening(): PageMessage {
    const { scenario, text, study, recording, seed, run } = this.source;
    const changes: Change[] | null = this.setting ? this.setting.log : this.source.changes;
    const { tick } = this;
    const seedField = seed === null ? {} : { seed };
    return { type: "open", scenario, text, study, recording, ...seedField, run, changes, tick };
  }

  private send(command: PageMessage): void {
    this.connection.send(command);
  }
}
