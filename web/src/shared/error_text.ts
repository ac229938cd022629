/** The message of an error, for display. */
export function errorText(error: unknown): string {
  // Without a server, `fetch` throws a TypeError with a message of the browser's.
  if (error instanceof TypeError || !(error instanceof Error)) return "The server is not responding.";
  return error.message;
}

/** The message of an error in a scenario file without the file and the line, for display beside them. */
export function withoutPlace(message: string): string {
  return message.replace(/^.*?\.toml(:\d+)?: /, "");
}
