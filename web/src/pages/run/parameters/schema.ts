import type { Json, Table } from "../../../api/protocol";

/** The part of JSON Schema that the page uses. */
export interface Schema {
  type?: string;
  description?: string;
  properties?: Record<string, Schema>;
  additionalProperties?: boolean | Schema;
  items?: Schema;
  anyOf?: Schema[];
  oneOf?: Schema[];
  allOf?: Schema[];
  $ref?: string;
  enum?: Json[];
  const?: Json;
  default?: Json;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  required?: string[];
  minItems?: number;
  maxItems?: number;
  definitions?: Record<string, Schema>;
  /** The table of the document whose keys are allowed besides the names of the alternatives. */
  "x-names"?: string;
}

/** The schema with its references inlined; its own keys take precedence. */
export function resolved(schema: Schema, root: Schema): Schema {
  const { $ref, allOf, ...own } = schema;
  const parts = [...(allOf ?? [])];
  const name = $ref?.replace("#/definitions/", "");
  const target = name === undefined ? undefined : root.definitions?.[name];
  if (target) parts.push(target);
  return Object.assign({}, ...parts.map((part) => resolved(part, root)), own) as Schema;
}

export function isTable(value: Json | undefined): value is { [key: string]: Json } {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

/** The alternative of a schema that a value matches; without a value, the one that is a scalar. */
export function variantOf(schema: Schema, value: Json | undefined, root: Schema): Schema | null {
  const alternatives = (schema.anyOf ?? schema.oneOf)?.map((one) => resolved(one, root));
  if (!alternatives || schema.properties) return schema;
  if (value === undefined) return alternatives.find(isSingle) ?? null;
  return alternatives.find((one) => fits(one, value)) ?? null;
}

/** The allowed names, if the schema allows only names, some of which may be keys of a table of the document. */
export function choicesOf(schema: Schema, root: Schema, document: Table): string[] | null {
  const { "x-names": table, ...rest } = schema;
  if (table !== undefined) {
    const [listed, others] = [rest.anyOf?.[0], document[table]];
    const names = listed && choicesOf(resolved(listed, root), root, document);
    return [...(names ?? []), ...(isTable(others) ? Object.keys(others) : [])];
  }
  if (schema.enum) return schema.enum.filter((name): name is string => typeof name === "string");
  const alternatives = (schema.anyOf ?? schema.oneOf)?.map((one) => resolved(one, root).const);
  if (!alternatives || alternatives.length === 0) return null;
  return alternatives.every((name): name is string => typeof name === "string") ? alternatives : null;
}

function isSingle(schema: Schema): boolean {
  return schema.type === "number" || schema.type === "integer" || schema.type === "boolean";
}

function fits(schema: Schema, value: Json): boolean {
  if (schema.type === "array") return Array.isArray(value);
  if (schema.type === "number" || schema.type === "integer") return typeof value === "number";
  if (schema.type !== "object") return schema.type === typeof value;
  if (!isTable(value)) return false;
  const kind = schema.properties?.kind?.const;
  if (kind !== undefined) return value.kind === kind;
  return (schema.required ?? []).every((name) => name in value);
}
