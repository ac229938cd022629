import type {
  Economy,
  Ended,
  Exported,
  Lanes,
  MapPart,
  Opened,
  Refused,
  Saved,
  Saving,
  SeriesAnswer,
  Setting,
  State,
} from "./protocol";
import type { StudyProgress } from "./study";

export type Message =
  | Opened
  | Setting
  | State
  | MapPart
  | Economy
  | Lanes
  | Refused
  | Saving
  | Saved
  | Exported
  | SeriesAnswer
  | Ended
  | StudyProgress;

const types = [
  "opened",
  "setting",
  "state",
  "map",
  "economy",
  "lanes",
  "refused",
  "saving",
  "saved",
  "exported",
  "series",
  "ended",
  "study_progress",
];

/** Decodes a message of the server; null if its type is unknown. */
export function readMessage(text: string): Message | null {
  try {
    const message: unknown = JSON.parse(text);
    if (typeof message !== "object" || message === null || !("type" in message)) return null;
    return types.includes(String(message.type)) ? (message as Message) : null;
  } catch {
    return null;
  }
}
