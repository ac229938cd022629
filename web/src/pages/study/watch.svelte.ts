import { browserWires, Connection, type Listener } from "../../api/connection";
import type { Message } from "../../api/messages";
import { resume, stop, study } from "../../api/studies";
import { Refusal, type Study, type StudyState, type Studying } from "../../api/study";
import { following } from "./standings";
import { troubleOf } from "./labels";

/** `lost` while the server is called again; `refused` if there is no such study. */
export type LinePhase = "opening" | "there" | "lost" | "refused";

/** A study as the page knows it, and the commands to it. */
export class Watch implements Listener {
  phase = $state<LinePhase>("opening");
  study = $state.raw<Study | null>(null);
  state = $state<StudyState | null>(null);
  race = $state.raw<Studying | null>(null);
  /** Of all configurations. */
  labels = $state.raw<string[]>([]);
  /** Milliseconds until the line is tried again. */
  again_ms = $state(0);
  /** Why the study could not be opened, or a command was not obeyed. */
  trouble = $state("");

  private readonly connection: Connection;
  private asked = 0;
  private isClosed = false;
  /** Whether what is known of the study may be of before. */
  private isStale = true;

  constructor(private readonly id: string) {
    this.connection = new Connection(this, browserWires(`ws?${new URLSearchParams({ study: id })}`));
  }

  start(): void {
    this.connection.start();
  }

  close(): void {
    this.isClosed = true;
    this.connection.close();
  }

  async stop(): Promise<void> {
    this.trouble = "";
    try {
      await stop(this.id);
    } catch (fault) {
      this.trouble = troubleOf(fault);
    }
  }

  /** Goes on, up to a higher confidence if one is given; returns why not, empty if it does. */
  async resume(confidence: number | null): Promise<string> {
    try {
      await resume(this.id, confidence);
      return "";
    } catch (fault) {
      return troubleOf(fault);
    } finally {
      // Also if that was refused: another page may have been faster.
      this.connection.start();
    }
  }

  /** Looks whether a study that stood goes on: others can see to that. */
  lookAgain(): void {
    if (this.phase === "there" && this.state !== "running") this.connection.start();
  }

  // What the line tells.

  ready(): void {
    this.isStale = true;
  }

  lost(again_ms: number): void {
    this.phase = "lost";
    this.again_ms = again_ms;
  }

  frame(): void {}

  message(message: Message): void {
    if (message.type === "ended") this.turnedAway(message.message);
    if (message.type !== "studying") return;
    this.phase = "there";
    if (message.labels) this.labels = message.labels;
    this.race = following(this.race, message);
    // What a study asks and its answer are in files, which are other ones after a new state.
    const isNew = this.isStale || message.state !== this.state;
    this.isStale = false;
    this.state = message.state;
    if (message.state !== "running") this.connection.close();
    if (isNew) void this.load();
  }

  private async load(): Promise<void> {
    this.asked += 1;
    const asked = this.asked;
    try {
      const loaded = await study(this.id);
      // Answers may overtake each other; the last question is the one that counts.
      if (asked !== this.asked) return;
      this.study = loaded;
      this.trouble = "";
    } catch (fault) {
      if (!this.isClosed) this.missed(fault);
    }
  }

  private turnedAway(why: string): void {
    this.trouble = why;
    this.phase = "refused";
    this.connection.close();
  }

  private missed(fault: unknown): void {
    this.trouble = troubleOf(fault);
    if (fault instanceof Refusal) this.turnedAway(this.trouble);
  }
}
