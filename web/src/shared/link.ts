import type { Change, Json, StudyConfiguration } from "../api/protocol";

/** A run in an address: opening it gives the same run at the same step. */
export interface Link {
  scenario: string | null;
  /** Text of the user's own scenario, packed (`packed_text.ts`). */
  text: string | null;
  /** A configuration of a study, in place of a scenario. */
  study: StudyConfiguration | null;
  /** A recording by name. It contains scenario, seed and run, and the changes unless others are given. */
  recording: string | null;
  /** Whether it is the live run of the server, at its present. Only `view` and `robot` belong to its address. */
  live: boolean;
  /** Null: the study's seed, or that of the live run. */
  seed: string | null;
  run: string;
  /** Null: the recording's changes. */
  changes: Change[] | null;
  tick: number;
  /** Centre x and y, and pixels per unit of the world. */
  view: [number, number, number] | null;
  robot: string | null;
  /** The ids of the signals in the chart. */
  charts: string[];
}

/** Some programs truncate longer addresses. */
export const maxLinkLength = 8000;

/** Signals in an address. */
const maxCharts = 32;

/** Characters of a damaged part that are displayed. */
const longestShown = 60;

export const emptyLink: Link = {
  scenario: null,
  text: null,
  study: null,
  recording: null,
  live: false,
  seed: "0",
  run: "0",
  changes: [],
  tick: 0,
  view: null,
  robot: null,
  charts: [],
};

/** The hash of the address of a run, such as `#/run?scenario=search&seed=7`. */
export function writeLink(link: Link): string {
  const query = new URLSearchParams();
  if (link.live) query.set("live", "1");
  else writeRun(link, query);
  if (link.view) query.set("view", link.view.map((value) => Number(value.toPrecision(5))).join(","));
  if (link.robot !== null) query.set("robot", link.robot);
  for (const signal of link.charts) query.append("chart", signal);
  return `#/run?${unescapeReadable(query.toString())}`;
}

function writeRun(link: Link, query: URLSearchParams): void {
  if (link.scenario !== null) query.set("scenario", link.scenario);
  if (link.text !== null) query.set("text", link.text);
  if (link.study) {
    query.set("study", link.study.id);
    query.set("configuration", String(link.study.configuration));
  }
  if (link.recording !== null) {
    query.set("recording", link.recording);
    if (link.changes) query.set("changes", JSON.stringify(link.changes));
  } else {
    if (link.seed !== null) query.set("seed", link.seed);
    query.set("run", link.run);
    if (link.changes?.length) query.set("changes", JSON.stringify(link.changes));
  }
  if (link.tick > 0) query.set("tick", String(link.tick));
}

/** What is wrong with the query of an address: a line for each part that cannot be read. Other parts may be missing. */
export function damagesOf(query: URLSearchParams): string[] {
  const readers: Record<string, (text: string) => boolean> = {
    live: (text) => text === "1",
    configuration: (text) => readConfiguration(text) !== null,
    seed: isWhole,
    run: isWhole,
    tick: (text) => isWhole(text) && Number.isSafeInteger(Number(text)),
    changes: (text) => readChanges(text) !== null,
    view: (text) => readView(text) !== null,
  };
  const parts = Object.entries(readers).map(([name, reads]) => ({ name, text: query.get(name), reads }));
  const damaged = parts.filter(({ text, reads }) => text !== null && !reads(text));
  const lines = damaged.map(({ name, text }) => `${name}=${shown(text ?? "")}`);
  if (query.has("study") && !query.has("configuration")) lines.push("configuration: it is missing");
  return [...sourceDamages(query), ...lines];
}

function sourceDamages(query: URLSearchParams): string[] {
  const sources = ["scenario", "text", "study", "recording", "live"].filter((name) => query.has(name));
  if (sources.length === 0) return ["scenario, text, study, recording or live: there is none"];
  if (sources.length > 1) return [`${sources.join(", ")}: only one of them can be opened`];
  const others = ["configuration", "seed", "run", "changes", "tick"].filter((name) => query.has(name));
  return query.has("live") ? others.map((name) => `${name}: a live run is opened as it is`) : [];
}

/** The link in the query of an address without damages. */
export function readLink(query: URLSearchParams): Link {
  const study = readStudy(query.get("study"), query.get("configuration"));
  const recording = query.get("recording");
  const live = query.has("live");
  const isRecorded = recording !== null && !query.has("changes");
  return {
    scenario: query.get("scenario"),
    text: query.get("text"),
    study,
    recording,
    live,
    seed: (study || live) && !query.has("seed") ? null : whole(query.get("seed")),
    run: whole(query.get("run")),
    changes: isRecorded ? null : (readChanges(query.get("changes") ?? "[]") ?? []),
    tick: Number(whole(query.get("tick"))),
    view: readView(query.get("view") ?? ""),
    robot: query.get("robot"),
    charts: [...new Set(query.getAll("chart"))].slice(0, maxCharts),
  };
}

/** The address of a study, or of the runs of one of its configurations. */
export function studyLink(id: string, configuration?: number): string {
  const query = new URLSearchParams({ id });
  if (configuration !== undefined) query.set("configuration", String(configuration));
  return `#/study?${unescapeReadable(query.toString())}`;
}

/** The address of two studies side by side. */
export function compareStudiesLink(one: string, other: string): string {
  return `#/study/compare?${unescapeReadable(new URLSearchParams({ a: one, b: other }).toString())}`;
}

/** The address of the form for a new study of a link's scenario. */
export function newStudyLink({ scenario, text }: Pick<Link, "scenario" | "text">): string {
  const query: Record<string, string> = text === null ? { scenario: scenario ?? "" } : { text };
  return `#/study/new?${unescapeReadable(new URLSearchParams(query).toString())}`;
}

/** The last change of each path at each tick. A run with all changes may still differ from one with these. */
export function shortened(changes: Change[]): Change[] {
  return changes.filter(
    ([tick, path], i) => !changes.some(([t, p], j) => j > i && t === tick && overrides(p, path)),
  );
}

/** Whether a value at `outer` replaces that at `inner`. */
function overrides(outer: string, inner: string): boolean {
  return inner === outer || inner.startsWith(`${outer}.`);
}

/** Restores characters that need no escape after `#` and are frequent in lists of changes. */
function unescapeReadable(query: string): string {
  return query
    .replaceAll("%2F", "/")
    .replaceAll("%2C", ",")
    .replaceAll("%3A", ":")
    .replaceAll("%5B", "[")
    .replaceAll("%5D", "]");
}

function isWhole(text: string): boolean {
  return /^\d{1,20}$/.test(text);
}

function whole(text: string | null): string {
  return text !== null && isWhole(text) ? text : "0";
}

function shown(text: string): string {
  return text.length > longestShown ? `${text.slice(0, longestShown)}…` : text;
}

/** The number of a configuration; null if the text is not a number. */
export function readConfiguration(text: string | null): number | null {
  return text !== null && /^\d{1,9}$/.test(text) ? Number(text) : null;
}

function readStudy(id: string | null, given: string | null): StudyConfiguration | null {
  const configuration = readConfiguration(given);
  return id === null || configuration === null ? null : { id, configuration };
}

function readView(text: string): Link["view"] {
  const [x, y, scale, ...rest] = text.split(",").map(Number);
  if (x === undefined || y === undefined || scale === undefined || rest.length > 0) return null;
  return [x, y, scale].every(Number.isFinite) && scale > 0 ? [x, y, scale] : null;
}

/** The changes; null if one of them cannot be read. */
function readChanges(text: string): Change[] | null {
  try {
    const read: Json = JSON.parse(text);
    return Array.isArray(read) && read.every(isChange) ? read : null;
  } catch {
    return null;
  }
}

function isChange(given: Json): given is Change {
  if (!Array.isArray(given) || given.length !== 3) return false;
  const [tick, path] = given;
  return Number.isInteger(tick) && Number(tick) >= 0 && typeof path === "string";
}
