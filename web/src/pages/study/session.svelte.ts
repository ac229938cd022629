import { browserTransport, Connection, type Listener } from "../../api/connection";
import type { ServerMessage } from "../../api/protocol";
import { resume, stop, study } from "../../api/studies";
import { RequestError, type Study, type StudyState, type StudyProgress } from "../../api/study";
import { updatedRace } from "./standings";
import { errorText } from "../../shared/error_text";

/** `lost` while reconnecting; `refused` if the study does not exist. */
export type ConnectionPhase = "opening" | "open" | "lost" | "refused";

/** A study on the page, and the commands to it. */
export class StudySession implements Listener {
  phase = $state<ConnectionPhase>("opening");
  study = $state.raw<Study | null>(null);
  state = $state<StudyState | null>(null);
  race = $state.raw<StudyProgress | null>(null);
  /** Labels of all configurations. */
  labels = $state.raw<string[]>([]);
  /** Milliseconds until the next attempt to connect. */
  retry_ms = $state(0);
  /** Why the study could not be opened, or a command failed. */
  failure = $state("");

  private readonly connection: Connection;
  private loads = 0;
  private isClosed = false;
  /** Whether the loaded study may be out of date. */
  private isStale = true;

  constructor(private readonly id: string) {
    this.connection = new Connection(this, browserTransport(`ws?${new URLSearchParams({ study: id })}`));
  }

  start(): void {
    this.connection.start();
  }

  close(): void {
    this.isClosed = true;
    this.connection.close();
  }

  async stop(): Promise<void> {
    this.failure = "";
    try {
      await stop(this.id);
    } catch (error) {
      this.failure = errorText(error);
    }
  }

  /** Resumes the study, with a higher confidence if given. Returns the error, or an empty string. */
  async resume(confidence: number | null): Promise<string> {
    try {
      await resume(this.id, confidence);
      return "";
    } catch (error) {
      return errorText(error);
    } finally {
      // Also after an error: another page may have resumed the study.
      this.connection.start();
    }
  }

  /** Reconnects to a study that is not running: another page may have resumed it. */
  refresh(): void {
    if (this.phase === "open" && this.state !== "running") this.connection.start();
  }

  // Events of the connection.

  ready(): void {
    this.isStale = true;
  }

  lost(retry_ms: number): void {
    this.phase = "lost";
    this.retry_ms = retry_ms;
  }

  frame(): void {}

  message(message: ServerMessage): void {
    if (message.type === "ended") this.reject(message.message);
    if (message.type !== "study_progress") return;
    this.phase = "open";
    if (message.labels) this.labels = message.labels;
    this.race = updatedRace(this.race, message);
    // The plan and the answer may have changed with the state.
    const isNew = this.isStale || message.state !== this.state;
    this.isStale = false;
    this.state = message.state;
    if (message.state !== "running") this.connection.close();
    if (isNew) void this.load();
  }

  private async load(): Promise<void> {
    this.loads += 1;
    const load = this.loads;
    try {
      const loaded = await study(this.id);
      // Responses may arrive out of order; only the last request counts.
      if (load !== this.loads) return;
      this.study = loaded;
      this.failure = "";
    } catch (error) {
      if (!this.isClosed) this.loadFailed(error);
    }
  }

  private reject(why: string): void {
    this.failure = why;
    this.phase = "refused";
    this.connection.close();
  }

  private loadFailed(error: unknown): void {
    this.failure = errorText(error);
    if (error instanceof RequestError) this.reject(this.failure);
  }
}
