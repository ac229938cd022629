import type { Json, KindView, Parameter as Described, Setting, PathStep, Table } from "../../../api/protocol";

/** A value that a slider, number box or switch can set. */
export interface Parameter extends Described {
  /** As error messages write it: `robots.rover.brain.behaviours[0].near_m`. */
  path: string;
  minimum: number;
  maximum: number;
  /** The default; null if the page does not know it. */
  fallback: Json;
}

/** All parameters of a run, in the order of the schema of its scenario. */
export function parametersOf({ parameters, kinds }: Pick<Setting, "parameters" | "kinds">): Parameter[] {
  const known = knownOf(kinds);
  return parameters.map((one) => ({
    ...one,
    path: pathOf(one.steps),
    minimum: one.low ?? Number.NEGATIVE_INFINITY,
    maximum: one.high ?? Number.POSITIVE_INFINITY,
    fallback: valueAt(known, one.steps) ?? one.default,
  }));
}

export function isTable(value: Json | undefined): value is Table {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

export function pathOf(steps: PathStep[]): string {
  return steps
    .map((step, i) => (typeof step === "number" ? `[${step}]` : i > 0 ? `.${step}` : step))
    .join("");
}

/** The change that sets a parameter. Paths end at lists: a value inside a list is set with the whole list. */
export function changeOf(document: Table, steps: PathStep[], value: Json): { path: string; value: Json } {
  const end = steps.findIndex((step) => typeof step === "number");
  if (end < 0) return { path: pathOf(steps), value };
  const outer = steps.slice(0, end);
  return { path: pathOf(outer), value: replaced(valueAt(document, outer) ?? [], steps.slice(end), value) };
}

export function valueAt(document: Json | undefined, steps: PathStep[]): Json | undefined {
  return steps.reduce<Json | undefined>((value, step) => {
    if (Array.isArray(value)) return value[Number(step)];
    return isTable(value) ? value[step] : undefined;
  }, document);
}

function replaced(whole: Json, [step, ...rest]: PathStep[], value: Json): Json {
  if (step === undefined) return value;
  if (Array.isArray(whole)) return whole.map((part, i) => (i === step ? replaced(part, rest, value) : part));
  const table = isTable(whole) ? whole : {};
  return { ...table, [step]: replaced(table[step] ?? {}, rest, value) };
}

/** Values of robot kinds without a default in the schema, because a robot model may supply them. */
function knownOf(kinds: KindView[]): Table {
  const robots = kinds.map((kind): [string, Json] => {
    const sensors = kind.sensors.map((sensor): [string, Json] => [
      sensor.name,
      { fov_deg: degrees(sensor.width_rad), facing_deg: degrees(sensor.facing_rad) },
    ]);
    return [kind.name, { layer: kind.is_flying ? "air" : "ground", sensors: Object.fromEntries(sensors) }];
  });
  return { robots: Object.fromEntries(robots) };
}

function degrees(rad: number): number {
  return Number(((rad * 180) / Math.PI).toFixed(3));
}
