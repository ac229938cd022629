import { plan, start } from "../../api/studies";
import {
  type Factors,
  RequestError,
  type ScenarioSource,
  type StudyPlan,
  type StudyRequest,
  type StudySummary,
} from "../../api/study";
import { requestOf, type Draft, draftOf, type FieldErrors, fieldErrors } from "./draft";
import { errorText } from "../../shared/error_text";

const debounce_ms = 250;
const retry_ms = 2000;

/** The study form: its fields, and the server's plan for them. */
export class FormState {
  draft = $state<Draft>() as Draft;
  planned = $state.raw<StudyPlan | null>(null);
  errors = $state.raw<FieldErrors>({});
  /** Why there is no answer from the server. */
  failure = $state("");
  isStarting = $state(false);

  private timer: ReturnType<typeof setTimeout> | undefined;
  private pending: AbortController | null = null;

  constructor(
    private readonly source: ScenarioSource,
    readonly factors: Factors,
  ) {
    this.draft = draftOf(factors);
  }

  /** Requests the plan of the draft, once typing pauses. */
  changed(wait_ms = debounce_ms): void {
    clearTimeout(this.timer);
    this.pending?.abort();
    const request = this.request();
    if (request) this.timer = setTimeout(() => void this.loadPlan(request), wait_ms);
  }

  close(): void {
    clearTimeout(this.timer);
    this.pending?.abort();
  }

  /** Starts the study; null if the server refuses. */
  async start(): Promise<StudySummary | null> {
    const request = this.request();
    if (!request || this.isStarting) return null;
    this.isStarting = true;
    try {
      return await start(request);
    } catch (error) {
      this.failed(error);
      return null;
    } finally {
      this.isStarting = false;
    }
  }

  private request(): StudyRequest | null {
    const result = requestOf(this.source, this.draft, this.factors.factors);
    if ("request" in result) return result.request;
    this.errors = result.errors;
    this.planned = null;
    return null;
  }

  private async loadPlan(request: StudyRequest): Promise<void> {
    const pending = new AbortController();
    this.pending = pending;
    try {
      this.planned = await plan(request, pending.signal);
      this.errors = {};
      this.failure = "";
    } catch (error) {
      if (pending.signal.aborted) return;
      this.planned = null;
      this.failed(error);
    }
  }

  private failed(error: unknown): void {
    this.errors = error instanceof RequestError ? fieldErrors(error.errors, this.draft) : {};
    this.failure = error instanceof RequestError ? "" : errorText(error);
    if (this.failure) this.changed(retry_ms);
  }
}
