import { postJson, request } from "./http";
import type { Json } from "./protocol";
import type {
  Factors,
  ScenarioSource,
  Study,
  StudyList,
  StudyPlan,
  StudyRequest,
  StudyRuns,
  StudySummary,
} from "./study";

export function factors(source: ScenarioSource): Promise<Factors> {
  return postJson("api/factors", source);
}

export function plan(study: StudyRequest, signal?: AbortSignal): Promise<StudyPlan> {
  return postJson("api/plan", study, signal);
}

export async function studies(): Promise<StudySummary[]> {
  const { studies } = await get<StudyList>("api/studies");
  return studies;
}

export function start(study: StudyRequest): Promise<StudySummary> {
  return postJson("api/studies", study);
}

export function stop(id: string): Promise<StudySummary> {
  return postJson("api/studies/stop", { id });
}

/** Resumes a study, with a higher confidence if given. */
export function resume(id: string, confidence: number | null): Promise<StudySummary> {
  return postJson("api/studies/resume", { id, confidence });
}

export function study(id: string): Promise<Study> {
  return get(`api/study?${new URLSearchParams({ id })}`);
}

export function runsOf(id: string, configuration: number, first: number, count: number): Promise<StudyRuns> {
  return get(runsAt(id, configuration, { first, count }));
}

/** Runs at evenly spaced quantiles of their merit, from worst to best. */
export function sampleOf(id: string, configuration: number, sample: number): Promise<StudyRuns> {
  return get(runsAt(id, configuration, { sample }));
}

/** The run in the middle, from the worst to the best; of a study with a requirement, from the fastest to the slowest. */
export function medianOf(id: string, configuration: number): Promise<StudyRuns> {
  return get(runsAt(id, configuration, { median: 1 }));
}

/** The question of a study, with all values of its scenario. */
export function questionOf(id: string): Promise<Record<string, Json>> {
  return get(`api/study/question?${new URLSearchParams({ id })}`);
}

export function download(id: string, what: "report" | "answer"): string {
  return `api/study/${what}?${new URLSearchParams({ id })}`;
}

function runsAt(id: string, configuration: number, more: Record<string, number>): string {
  const numbers = Object.entries({ configuration, ...more }).map(([name, value]) => [name, String(value)]);
  return `api/study/runs?${new URLSearchParams([["id", id], ...numbers])}`;
}

async function get<Response>(path: string): Promise<Response> {
  return (await request(path)).json() as Promise<Response>;
}
