import { Connection, type Listener } from "../../api/connection";
import type { Frame } from "../../api/frames";
import type { Message } from "../../api/messages";
import type {
  Asked,
  Change,
  Command,
  Ended,
  Fault,
  Json,
  MapPart,
  Opened,
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

/** `opening` until the server has said what runs; `lost` while it is called again. */
export type Phase = "opening" | "open" | "lost" | "refused" | "ended";

/** What is to be run: of an address, with the text unpacked. */
export type Source = Omit<Link, "text" | "view"> & { text: string | null };

/** A value on its way into the scenario. */
interface Put {
  value: Json;
  /** Whether it takes the place of the one that was put there before, if the run has not gone on. */
  instead: boolean;
}

const changes_ms = 50;
/** Numbers that change more often are hard to read, and each time the page is put together anew. */
const words_ms = 180;
const states_ms = 180;

/** A run as the page knows it, and the commands to it. */
export class Session implements Listener {
  phase = $state<Phase>("opening");
  opened = $state.raw<Opened | null>(null);
  setting = $state.raw<Setting | null>(null);
  state = $state.raw<State | null>(null);
  /** Why the run could not be opened. */
  faults = $state.raw<Fault[]>([]);
  ended = $state.raw<Ended | null>(null);
  /** What was refused last, under the path of the change (or what else it was about). */
  refusals = $state.raw<Record<string, string>>({});
  selected = $state.raw<string | null>(null);
  /** What the selected robot believes of its field. */
  map = $state.raw<BelievedMap | null>(null);
  /** What frames come with. */
  asked = $state.raw<Asked | null>(null);
  /** How far the recording is that is being saved. */
  saving = $state.raw<Pick<Saving, "done" | "steps"> | null>(null);
  /** What was saved last, and of which changes. */
  saved = $state.raw<{ recording: RecordingEntry; changes: string } | null>(null);
  /** Milliseconds until the line is tried again. */
  again_ms = $state(0);
  /** How often `series` has got something new. */
  grown = $state(0);
  /** How often there was something new in the picture to put into words: five times a second at most. */
  seen = $state(0);
  series = new Series();

  readonly frames = new FrameQueue((frame) => this.send({ type: "got", frame }));
  /** Called when there is something new to draw. */
  onFrame = () => {};

  private readonly connection = new Connection(this);
  private readonly changes = new Throttle<Put>(
    changes_ms,
    (path, put) => this.send({ type: "change", path, ...put }),
    (passed, latest) => ({ ...latest, instead: passed.instead }),
  );
  private saw = 0;
  private toldAt = 0;
  private savedChanges = "";
  private takeExported: ((text: string) => void) | null = null;
  /** Speed to go on with once the run is opened again; undefined if it stood. */
  private goOn: Speed | undefined;

  constructor(private readonly source: Source) {
    this.selected = source.robot;
  }

  start(): void {
    this.connection.start();
  }

  close(): void {
    this.connection.close();
  }

  /** Opens an ended run once more. */
  again(): void {
    this.phase = "opening";
    this.start();
  }

  /** The text that is run, if it is not one of the server's scenarios. */
  get text(): string | null {
    return this.source.text;
  }

  /** Where the run stands, or is on its way to. */
  get tick(): number {
    return this.state?.aim ?? this.state?.tick ?? this.source.tick;
  }

  /** Whether it goes on by itself: plays, or is on its way to a moment. */
  get isGoing(): boolean {
    return this.state !== null && (this.state.playing || this.state.aim !== null);
  }

  /** The classic engine has robots of its own kind, and a world that nobody changes. */
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
    this.send({ type: "go", tick });
  }

  /** Changes the scenario, `instead` for what is but one more value of a slider that is being drawn. */
  change(path: string, value: Json, instead = false): void {
    this.changes.put(path, { value, instead });
  }

  undo(): void {
    this.send({ type: "undo" });
  }

  /** Makes a recording of the run, unless one is being made. */
  save(): void {
    if (this.saving) return;
    this.saving = { done: 0, steps: 0 };
    this.savedChanges = this.changesKey;
    this.send({ type: "save" });
  }

  cancelSaving(): void {
    this.send({ type: "cancel" });
  }

  /** What tells the changes of this run from others. */
  get changesKey(): string {
    return JSON.stringify(this.setting?.log ?? null);
  }

  /** The scenario as it is now, as a TOML file has it. */
  exported(): Promise<string> {
    this.send({ type: "export" });
    return new Promise((take) => {
      this.takeExported = take;
    });
  }

  select(robot: string | null): void {
    this.selected = robot;
    this.map = null;
    this.send({ type: "select", robot });
  }

  /** What frames are to come with from now on. */
  ask(asked: Asked): void {
    this.asked = asked;
    this.send({ type: "layers", ...asked });
  }

  // What the line tells.

  ready(): void {
    this.frames.clear();
    if (this.asked) this.ask(this.asked);
    this.send(this.opening());
  }

  lost(again_ms: number): void {
    if (this.phase === "ended" || this.phase === "refused") {
      this.connection.close();
      return;
    }
    this.saving = null;
    if (this.phase === "open") this.goOn = this.state?.playing ? this.state.speed : undefined;
    this.phase = "lost";
    this.again_ms = again_ms;
  }

  frame(frame: Frame): void {
    this.frames.put(frame);
    this.onFrame();
  }

  message(message: Message): void {
    if (message.type === "opened") this.begin(message);
    else if (message.type === "setting") this.set(message);
    else if (message.type === "state") this.told(message);
    else if (message.type === "map") this.mapped(message);
    else if (message.type === "refused") this.refuse(message);
    else if (message.type === "saving") this.saving = message;
    else if (message.type === "saved") this.keep(message.recording);
    else if (message.type === "exported") this.takeExported?.(message.text);
    else if (message.type === "ended") this.end(message);
  }

  /** The latest frame is in the picture. */
  drew(): void {
    const now = performance.now();
    if (this.state?.playing && now - this.saw < words_ms) return;
    this.saw = now;
    this.seen += 1;
  }

  private begin(opened: Opened): void {
    this.opened = opened;
    this.phase = "open";
    this.map = null;
    if (this.selected !== null) this.send({ type: "select", robot: this.selected });
    if (this.goOn !== undefined) this.play(this.goOn);
    this.goOn = undefined;
  }

  private set(setting: Setting): void {
    if (this.setting && this.setting.step_s !== setting.step_s) this.series.measure(setting.step_s);
    this.setting = setting;
    this.refusals = {};
    this.onFrame();
  }

  private told(state: State): void {
    this.series.add(state);
    const now = performance.now();
    // The next one comes soon while it runs; what has just begun or stopped is shown at once.
    if (state.playing && this.state?.playing && now - this.toldAt < states_ms) return;
    this.toldAt = now;
    this.state = state;
    this.grown += 1;
  }

  private mapped(part: MapPart): void {
    if (part.robot !== this.selected) return;
    this.map = BelievedMap.with(this.map, part);
    this.onFrame();
  }

  private keep(recording: RecordingEntry | null): void {
    this.saving = null;
    if (recording) this.saved = { recording, changes: this.savedChanges };
  }

  private refuse({ about, path, faults }: Refused): void {
    if (about === "save") this.saving = null;
    if (about === "open") {
      this.faults = faults;
      this.phase = "refused";
      this.connection.close();
      return;
    }
    const words = faults.map((fault) => fault.message).join(" ");
    this.refusals = { ...this.refusals, [path ?? about]: words };
  }

  private end(ended: Ended): void {
    this.ended = ended;
    this.phase = "ended";
    this.connection.close();
  }

  /** The run as it stands, so that a line that was lost goes on where it was. */
  private opening(): Command {
    const { scenario, text, study, recording, seed, run } = this.source;
    const changes: Change[] | null = this.setting ? this.setting.log : this.source.changes;
    const { tick } = this;
    const chance = seed === null ? {} : { seed };
    return { type: "open", scenario, text, study, recording, ...chance, run, changes, tick };
  }

  private send(command: Command): void {
    this.connection.send(command);
  }
}
