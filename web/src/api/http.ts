import type { ScenarioSummary, InputError, RecordingEntry, ScenarioEntry } from "./protocol";
import { RequestError } from "./study";

export async function scenarios(): Promise<ScenarioEntry[]> {
  return (await request("api/scenarios")).json() as Promise<ScenarioEntry[]>;
}

export async function recordings(): Promise<RecordingEntry[]> {
  return (await request("api/recordings")).json() as Promise<RecordingEntry[]>;
}

/** The address of a recording's file. */
export function recordingFile(id: string): string {
  return `api/recordings/file?id=${encodeURIComponent(id)}`;
}

export function picture(scenario: string): string {
  return `api/pictures?scenario=${encodeURIComponent(scenario)}`;
}

/** The first errors of an input, and the number of all. */
export interface InputErrors {
  errors: InputError[];
  total: number;
}

export type CheckResult = { scenario: ScenarioSummary } | InputErrors;

/** Checks the text of a scenario. */
export async function check(text: string): Promise<CheckResult> {
  const response = await fetch("api/check", {
    method: "POST",
    headers: { "Content-Type": "application/toml" },
    body: text,
  });
  if (response.status === 422) return (await response.json()) as InputErrors;
  if (!response.ok) throw new Error(`The server responded ${response.status} ${response.statusText}.`);
  return { scenario: (await response.json()) as ScenarioSummary };
}

/** The server's response. Throws a `RequestError` with the server's messages if it sends any. */
export async function request(path: string, options: RequestInit = {}): Promise<Response> {
  const response = await fetch(path, options);
  if (response.ok) return response;
  const body = (await response.json().catch(() => null)) as { errors?: InputError[] } | null;
  if (body?.errors) throw new RequestError(body.errors);
  throw new Error(`The server responded ${response.status} ${response.statusText}.`);
}

/** The server's response to a JSON object. Throws as `request`. */
export async function postJson<Response>(
  path: string,
  body: object,
  signal?: AbortSignal,
): Promise<Response> {
  const headers = { "Content-Type": "application/json" };
  const response = await request(path, {
    method: "POST",
    headers,
    body: JSON.stringify(body),
    ...(signal ? { signal } : {}),
  });
  return response.json() as Promise<Response>;
}
