import type { Json, KindView, Table } from "../../../api/protocol";
import { choicesOf, isTable, resolved, type Schema, variantOf } from "./schema";

export type Step = string | number;

/** A value that a slider, number box or switch can set. */
export interface Parameter {
  steps: Step[];
  /** As error messages write it: `robots.rover.brain.behaviours[0].near_m`. */
  path: string;
  help: string;
  type: "number" | "integer" | "boolean" | "choice";
  choices: string[];
  minimum: number;
  maximum: number;
  value: Json | undefined;
  /** The default; undefined if the page does not know it. */
  fallback: Json | undefined;
}

const notOfRun = new Set(["engine", "summary", "study", "published"]);

/** All parameters of a scenario, in the order of its schema. */
export function parametersOf(root: Schema, document: Table, kinds: KindView[] = []): Parameter[] {
  const top = Object.entries(root.properties ?? {}).filter(([name]) => !notOfRun.has(name));
  const known = knownOf(kinds);
  return top.flatMap(([name, schema]) =>
    new SchemaWalk(root, document).at(schema, document[name], known[name], [name]),
  );
}

export function pathOf(steps: Step[]): string {
  return steps
    .map((step, i) => (typeof step === "number" ? `[${step}]` : i > 0 ? `.${step}` : step))
    .join("");
}

/** The change that sets a parameter. Paths end at lists: a value inside a list is set with the whole list. */
export function changeOf(document: Table, steps: Step[], value: Json): { path: string; value: Json } {
  const end = steps.findIndex((step) => typeof step === "number");
  if (end < 0) return { path: pathOf(steps), value };
  const outer = steps.slice(0, end);
  return { path: pathOf(outer), value: replaced(valueAt(document, outer) ?? [], steps.slice(end), value) };
}

export function valueAt(document: Json | undefined, steps: Step[]): Json | undefined {
  return steps.reduce<Json | undefined>((value, step) => {
    if (Array.isArray(value)) return value[Number(step)];
    return isTable(value) ? value[step] : undefined;
  }, document);
}

function replaced(whole: Json, [step, ...rest]: Step[], value: Json): Json {
  if (step === undefined) return value;
  if (Array.isArray(whole)) return whole.map((part, i) => (i === step ? replaced(part, rest, value) : part));
  const table = isTable(whole) ? whole : {};
  return { ...table, [step]: replaced(table[step] ?? {}, rest, value) };
}

/** Values that robot models supply and robot kinds leave out, as far as the setting contains them. */
function knownOf(kinds: KindView[]): Table {
  const robots = kinds.map((kind): [string, Json] => {
    const sensors = kind.sensors.map((sensor): [string, Json] => [
      sensor.name,
      {
        kind: sensor.kind,
        range_m: sensor.range_m,
        fov_deg: degrees(sensor.width_rad),
        facing_deg: degrees(sensor.facing_rad),
      },
    ]);
    const radio: Table = kind.radio_range_m === null ? {} : { radio: { range_m: kind.radio_range_m } };
    const layer = kind.is_flying ? "air" : "ground";
    return [kind.name, { layer, radius_m: kind.radius, sensors: Object.fromEntries(sensors), ...radio }];
  });
  return { robots: Object.fromEntries(robots) };
}

function degrees(rad: number): number {
  return Number(((rad * 180) / Math.PI).toFixed(3));
}

class SchemaWalk {
  constructor(
    private readonly root: Schema,
    private readonly document: Table,
  ) {}

  at(given: Schema, value: Json | undefined, known: Json | undefined, steps: Step[]): Parameter[] {
    const outer = resolved(given, this.root);
    const choices = choicesOf(outer, this.root, this.document);
    if (choices) return [this.parameter(outer, "choice", choices, value, known, steps)];
    const schema = variantOf(outer, value ?? known, this.root);
    if (!schema) return [];
    const names = choicesOf(schema, this.root, this.document);
    if (names) return [this.parameter(outer, "choice", names, value, known, steps)];
    const { type } = schema;
    if (type === "number" || type === "integer" || type === "boolean") {
      const described = { ...schema, description: outer.description ?? schema.description };
      return [this.parameter(described, type, [], value, known, steps)];
    }
    if (type === "array") return this.list(schema, value, steps);
    return type === "object" ? this.table(schema, value, known, steps) : [];
  }

  private table(
    schema: Schema,
    value: Json | undefined,
    known: Json | undefined,
    steps: Step[],
  ): Parameter[] {
    const given = isTable(value) ? value : {};
    const supplied = isTable(known) ? known : {};
    const names = Object.entries(schema.properties ?? {});
    const { additionalProperties: named } = schema;
    if (typeof named === "object") {
      for (const name of new Set([...Object.keys(given), ...Object.keys(supplied)]))
        names.push([name, named]);
    }
    return names.flatMap(([name, child]) => this.at(child, given[name], supplied[name], [...steps, name]));
  }

  private list(schema: Schema, value: Json | undefined, steps: Step[]): Parameter[] {
    const { items } = schema;
    if (!Array.isArray(value) || !items) return [];
    const listsOfLists = resolved(items, this.root).type === "array";
    return listsOfLists ? [] : value.flatMap((part, i) => this.at(items, part, undefined, [...steps, i]));
  }

  private parameter(
    schema: Schema,
    type: Parameter["type"],
    choices: string[],
    value: Json | undefined,
    known: Json | undefined,
    steps: Step[],
  ): Parameter {
    return {
      steps,
      path: pathOf(steps),
      help: schema.description ?? "",
      type,
      choices,
      minimum: schema.minimum ?? schema.exclusiveMinimum ?? Number.NEGATIVE_INFINITY,
      maximum: schema.maximum ?? schema.exclusiveMaximum ?? Number.POSITIVE_INFINITY,
      value,
      fallback: known ?? schema.default,
    };
  }
}
