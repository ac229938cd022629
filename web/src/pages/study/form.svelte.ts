import { plan, start } from "../../api/studies";
import { type Ask, type Asked, type Factors, type Listed, type Planned, Refusal } from "../../api/study";
import { askOf, type Draft, draftOf, type Wrongs, wrongsOf } from "./draft";
import { troubleOf } from "./labels";

const rest_ms = 250;
const again_ms = 2000;

/** A study as it is being asked: what is typed, and what the server makes of it. */
export class Asking {
  draft = $state<Draft>() as Draft;
  planned = $state.raw<Planned | null>(null);
  wrongs = $state.raw<Wrongs>({});
  /** Why the server said nothing. */
  trouble = $state("");
  isStarting = $state(false);

  private timer: ReturnType<typeof setTimeout> | undefined;
  private asking: AbortController | null = null;

  constructor(
    private readonly of: Asked,
    readonly factors: Factors,
  ) {
    this.draft = draftOf(factors);
  }

  /** Asks for the plan of the draft, once it rests. */
  changed(wait_ms = rest_ms): void {
    clearTimeout(this.timer);
    this.asking?.abort();
    const ask = this.ask();
    if (ask) this.timer = setTimeout(() => void this.look(ask), wait_ms);
  }

  close(): void {
    clearTimeout(this.timer);
    this.asking?.abort();
  }

  /** Starts the study; gives it, or null if that was refused. */
  async start(): Promise<Listed | null> {
    const ask = this.ask();
    if (!ask || this.isStarting) return null;
    this.isStarting = true;
    try {
      return await start(ask);
    } catch (fault) {
      this.refused(fault);
      return null;
    } finally {
      this.isStarting = false;
    }
  }

  private ask(): Ask | null {
    const said = askOf(this.of, this.draft, this.factors.factors);
    if ("ask" in said) return said.ask;
    this.wrongs = said.wrongs;
    this.planned = null;
    return null;
  }

  private async look(ask: Ask): Promise<void> {
    const asking = new AbortController();
    this.asking = asking;
    try {
      this.planned = await plan(ask, asking.signal);
      this.wrongs = {};
      this.trouble = "";
    } catch (fault) {
      if (asking.signal.aborted) return;
      this.planned = null;
      this.refused(fault);
    }
  }

  private refused(fault: unknown): void {
    this.wrongs = fault instanceof Refusal ? wrongsOf(fault.faults, this.draft) : {};
    this.trouble = fault instanceof Refusal ? "" : troubleOf(fault);
    if (this.trouble) this.changed(again_ms);
  }
}
