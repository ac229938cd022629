import type { Checked, Fault, ScenarioEntry } from "./protocol";

export async function scenarios(): Promise<ScenarioEntry[]> {
  return (await asked("api/scenarios")).json() as Promise<ScenarioEntry[]>;
}

export async function schema(): Promise<unknown> {
  return (await asked("api/schema")).json();
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

async function asked(path: string): Promise<Response> {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`The server answered ${answer.status} ${answer.statusText}.`);
  return answer;
}
