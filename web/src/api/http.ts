import type { Checked, Engine, Fault, RecordingEntry, ScenarioEntry } from "./protocol";
import { Refusal } from "./study";

export async function scenarios(): Promise<ScenarioEntry[]> {
  return (await asked("api/scenarios")).json() as Promise<ScenarioEntry[]>;
}

export async function recordings(): Promise<RecordingEntry[]> {
  return (await asked("api/recordings")).json() as Promise<RecordingEntry[]>;
}

/** The address of a recording's file. */
export function recordingFile(id: string): string {
  return `api/recordings/file?id=${encodeURIComponent(id)}`;
}

/** The schema of an engine's scenarios. */
export async function schema(engine: Engine): Promise<unknown> {
  return (await asked(`api/schema?engine=${engine}`)).json();
}

export function picture(scenario: string): string {
  return `api/pictures?scenario=${encodeURIComponent(scenario)}`;
}

export type Verdict = { scenario: Checked } | { faults: Fault[] };

/** What the server says of a scenario's text. */
export async function check(text: string): Promise<Verdict> {
  const answer = await fetch("api/check", {
    method: "POST",
    headers: { "Content-Type": "application/toml" },
    body: text,
  });
  if (answer.status === 422) return (await answer.json()) as { faults: Fault[] };
  if (!answer.ok) throw new Error(`The server answered ${answer.status} ${answer.statusText}.`);
  return { scenario: (await answer.json()) as Checked };
}

/** The server's answer; throws a `Refusal` with the server's words where it gives any. */
export async function asked(path: string, request: RequestInit = {}): Promise<Response> {
  const answer = await fetch(path, request);
  if (answer.ok) return answer;
  const said = (await answer.json().catch(() => null)) as { faults?: Fault[] } | null;
  if (said?.faults) throw new Refusal(said.faults);
  throw new Error(`The server answered ${answer.status} ${answer.statusText}.`);
}
