import { type Drive, findDrive } from "../api/warden";
import type { EmergencyStop } from "./emergency_stop";
import { addStopBar } from "./stop_bar";

const retry_ms = 1000;

/** The drive of this page's server, if it has one. */
class CurrentDrive {
  /** Undefined until the server has answered. */
  found = $state.raw<Drive | null | undefined>(undefined);
  private stop: EmergencyStop | null = null;

  /** Finds the drive, and adds the emergency stop to the page. */
  async load(): Promise<void> {
    try {
      const drive = await findDrive();
      if (drive) this.stop = addStopBar(drive);
      this.found = drive;
    } catch {
      setTimeout(() => void this.load(), retry_ms);
    }
  }

  /** Requests the emergency stop of all robots. */
  stopAll(): void {
    this.stop?.request();
  }
}

export const drive = new CurrentDrive();
