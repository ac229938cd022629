import { studies } from "../../api/studies";
import type { Listed } from "../../api/study";
import { troubleOf } from "./labels";

const again_ms = 2000;

/** The studies that there are: looked at again while any runs, or while the server does not answer. */
export class StudyList {
  listed = $state.raw<Listed[] | null>(null);
  trouble = $state("");

  private timer: ReturnType<typeof setTimeout> | undefined;
  private isClosed = false;

  close(): void {
    this.isClosed = true;
    clearTimeout(this.timer);
  }

  async look(): Promise<void> {
    clearTimeout(this.timer);
    try {
      this.listed = await studies();
      this.trouble = "";
    } catch (fault) {
      this.trouble = troubleOf(fault);
    }
    const isMoving = this.trouble !== "" || this.listed?.some(({ state }) => state === "running");
    if (isMoving && !this.isClosed) this.timer = setTimeout(() => void this.look(), again_ms);
  }
}
