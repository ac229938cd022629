import { studies } from "../../api/studies";
import type { StudySummary } from "../../api/study";
import { errorText } from "../../shared/error_text";

const poll_ms = 2000;

/** The list of studies, polled while a study is running or the server is not responding. */
export class StudyList {
  listed = $state.raw<StudySummary[] | null>(null);
  failure = $state("");

  private timer: ReturnType<typeof setTimeout> | undefined;
  private isClosed = false;

  close(): void {
    this.isClosed = true;
    clearTimeout(this.timer);
  }

  async refresh(): Promise<void> {
    clearTimeout(this.timer);
    try {
      this.listed = await studies();
      this.failure = "";
    } catch (error) {
      this.failure = errorText(error);
    }
    const isChanging = this.failure !== "" || this.listed?.some(({ state }) => state === "running");
    if (isChanging && !this.isClosed) this.timer = setTimeout(() => void this.refresh(), poll_ms);
  }
}
