import type { ServerMessage } from "./protocol";

const types = [
  "opened",
  "setting",
  "state",
  "map",
  "shown",
  "refused",
  "saving",
  "saved",
  "exported",
  "events",
  "signals",
  "series",
  "ended",
  "study_progress",
];

/** Decodes a message of the server; null if its type is unknown. */
export function readMessage(text: string): ServerMessage | null {
  try {
    const message: unknown = JSON.parse(text);
    if (typeof message !== "object" || message === null || !("type" in message)) return null;
    return types.includes(String(message.type)) ? (message as ServerMessage) : null;
  } catch {
    return null;
  }
}
