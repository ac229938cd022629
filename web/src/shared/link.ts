import type { Change, Json, OfStudy } from "../api/protocol";

/** What an address says of a run, so that opening it gives the same run at the same tick. */
export interface Link {
  scenario: string | null;
  /** Text of a scenario of one's own, packed (`packed.ts`). */
  text: string | null;
  /** A configuration of a study, in place of a scenario. */
  study: OfStudy | null;
  /** A recording by its name: it has a scenario, a seed and a run, and changes unless others are given. */
  recording: string | null;
  /** Null for that of the study. */
  seed: string | null;
  run: string;
  /** Null for those of the recording. */
  changes: Change[] | null;
  tick: number;
  /** Centre, and pixels a metre (or whatever the world's unit is). */
  view: [number, number, number] | null;
  robot: string | null;
}

/** Longer addresses get lost in some programs. */
export const longestLink = 8000;

export const emptyLink: Link = {
  scenario: null,
  text: null,
  study: null,
  recording: null,
  seed: "0",
  run: "0",
  changes: [],
  tick: 0,
  view: null,
  robot: null,
};

/** The hash of an address, such as `#/run?scenario=search&seed=7`. */
export function writeLink(link: Link): string {
  const query = new URLSearchParams();
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
  if (link.view) query.set("view", link.view.map((value) => Number(value.toPrecision(5))).join(","));
  if (link.robot !== null) query.set("robot", link.robot);
  return `#/run?${readable(query.toString())}`;
}

/** What the query of an address says; what it says wrongly is left out. */
export function readLink(query: URLSearchParams): Link {
  const study = readStudy(query.get("study"), query.get("configuration"));
  const recording = query.get("recording");
  const isRecorded = recording !== null && !query.has("changes");
  return {
    scenario: query.get("scenario"),
    text: query.get("text"),
    study,
    recording,
    seed: study && !query.has("seed") ? null : whole(query.get("seed")),
    run: whole(query.get("run")),
    changes: isRecorded ? null : readChanges(query.get("changes")),
    tick: Number(whole(query.get("tick"))),
    view: readView(query.get("view")),
    robot: query.get("robot"),
  };
}

/** The address of a study; with a configuration, of its runs there. */
export function studyLink(id: string, configuration?: number): string {
  const query = new URLSearchParams({ id });
  if (configuration !== undefined) query.set("configuration", String(configuration));
  return `#/study?${readable(query.toString())}`;
}

/** Where a new study of what a link runs is asked. */
export function newStudyLink({ scenario, text }: Pick<Link, "scenario" | "text">): string {
  const query: Record<string, string> = text === null ? { scenario: scenario ?? "" } : { text };
  return `#/study/new?${readable(new URLSearchParams(query).toString())}`;
}

/** What changes come to: of those of one path at one tick the last. A run that had all may still be another. */
export function shortened(changes: Change[]): Change[] {
  return changes.filter(
    ([tick, path], i) => !changes.some(([t, p], j) => j > i && t === tick && overrides(p, path)),
  );
}

/** Whether a value at `outer` replaces that at `inner`. */
function overrides(outer: string, inner: string): boolean {
  return inner === outer || inner.startsWith(`${outer}.`);
}

/** Signs that need no escape after a `#` and make up most of a list of changes. */
function readable(query: string): string {
  return query
    .replaceAll("%2F", "/")
    .replaceAll("%2C", ",")
    .replaceAll("%3A", ":")
    .replaceAll("%5B", "[")
    .replaceAll("%5D", "]");
}

function whole(text: string | null): string {
  return text !== null && /^\d{1,20}$/.test(text) ? text : "0";
}

/** Number of a configuration; null if it is none. */
export function readConfiguration(text: string | null): number | null {
  return text !== null && /^\d{1,9}$/.test(text) ? Number(text) : null;
}

function readStudy(id: string | null, given: string | null): OfStudy | null {
  const configuration = readConfiguration(given);
  return id === null || configuration === null ? null : { id, configuration };
}

function readView(text: string | null): Link["view"] {
  const [x, y, scale, ...rest] = (text ?? "").split(",").map(Number);
  if (x === undefined || y === undefined || scale === undefined || rest.length > 0) return null;
  return [x, y, scale].every(Number.isFinite) && scale > 0 ? [x, y, scale] : null;
}

function readChanges(text: string | null): Change[] {
  try {
    const read: Json = JSON.parse(text ?? "[]");
    return Array.isArray(read) ? read.filter(isChange) : [];
  } catch {
    return [];
  }
}

function isChange(given: Json): given is Change {
  if (!Array.isArray(given) || given.length !== 3) return false;
  const [tick, path] = given;
  return Number.isInteger(tick) && Number(tick) >= 0 && typeof path === "string";
}
