import type { InputError } from "../api/protocol";

/** The message of an error, for display. */
export function errorText(error: unknown): string {
  // Without a server, `fetch` throws a TypeError with a message of the browser's.
  if (error instanceof TypeError || !(error instanceof Error)) return "The server is not responding.";
  return error.message;
}

/** The message of an error in a file without its place, for display beside that. */
export function withoutPlace({ message, line }: Pick<InputError, "message" | "line">): string {
  const place = `:${line}: `;
  const at = message.indexOf(place);
  return line === null || at < 0 ? message : message.slice(at + place.length);
}
