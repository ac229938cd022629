import { asked } from "./http";
import type { Ask, Asked, Factors, Listed, Planned, Study, StudyRuns } from "./study";

export function factors(of: Asked): Promise<Factors> {
  return post("api/factors", of);
}

export function plan(ask: Ask, signal?: AbortSignal): Promise<Planned> {
  return post("api/plan", ask, signal);
}

export async function studies(): Promise<Listed[]> {
  const { studies } = await get<{ studies: Listed[] }>("api/studies");
  return studies;
}

export function start(ask: Ask): Promise<Listed> {
  return post("api/studies", ask);
}

export function stop(id: string): Promise<Listed> {
  return post("api/studies/stop", { id });
}

/** Goes on with a study; with a confidence it is tightened to that. */
export function resume(id: string, confidence: number | null): Promise<Listed> {
  return post("api/studies/resume", { id, confidence });
}

export function study(id: string): Promise<Study> {
  return get(`api/study?${new URLSearchParams({ id })}`);
}

export function runsOf(id: string, configuration: number, first: number, count: number): Promise<StudyRuns> {
  return get(runsAt(id, configuration, { first, count }));
}

/** Runs from the worst to the best, at evenly spaced quantiles of their merits. */
export function sampleOf(id: string, configuration: number, sample: number): Promise<StudyRuns> {
  return get(runsAt(id, configuration, { sample }));
}

export function download(id: string, what: "report" | "answer"): string {
  return `api/study/${what}?${new URLSearchParams({ id })}`;
}

function runsAt(id: string, configuration: number, more: Record<string, number>): string {
  const numbers = Object.entries({ configuration, ...more }).map(([name, value]) => [name, String(value)]);
  return `api/study/runs?${new URLSearchParams([["id", id], ...numbers])}`;
}

async function get<Answer>(path: string): Promise<Answer> {
  return (await asked(path)).json() as Promise<Answer>;
}

async function post<Answer>(path: string, body: object, signal?: AbortSignal): Promise<Answer> {
  const headers = { "Content-Type": "application/json" };
  const answer = await asked(path, {
    method: "POST",
    headers,
    body: JSON.stringify(body),
    ...(signal ? { signal } : {}),
  });
  return answer.json() as Promise<Answer>;
}
