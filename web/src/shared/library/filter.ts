/** An entry of a list as it is filtered and sorted. */
export interface Row {
  id: string;
  /** Its title, or what the list calls it without one. */
  name: string;
  note: string;
  tags: string[];
  bytes: number;
  /** When it was last changed, in seconds since 1970. */
  date_s: number;
  /** Its state in words. */
  state: string;
}

export const sortKeys = ["name", "date", "size", "state"] as const;
export type SortKey = (typeof sortKeys)[number];

export interface Sort {
  key: SortKey;
  descending: boolean;
}

/** What a list shows, and in which order. */
export interface Filter {
  /** All of its words are in the name, the id, the note or a tag. */
  text: string;
  /** An entry has all of them. */
  tags: string[];
  sort: Sort;
}

/** The filter in the query of an address; what cannot be read is as `usual`. */
export function readFilter(hash: string, usual: Sort): Filter {
  const query = new URLSearchParams(hash.split("?")[1] ?? "");
  return {
    text: query.get("filter") ?? "",
    tags: [...new Set(query.getAll("tag"))],
    sort: readSort(query.get("sort") ?? "") ?? usual,
  };
}

/** The address of a list with a filter. */
export function writeFilter(hash: string, { text, tags, sort }: Filter, usual: Sort): string {
  const query = new URLSearchParams();
  if (text !== "") query.set("filter", text);
  for (const tag of tags) query.append("tag", tag);
  if (sort.key !== usual.key || sort.descending !== usual.descending)
    query.set("sort", `${sort.descending ? "-" : ""}${sort.key}`);
  const path = hash.split("?")[0] || "#/";
  return query.size > 0 ? `${path}?${query}` : path;
}

/** The rows that a filter lets through, in its order. */
export function visibleRows<Given extends Row>(rows: Given[], { text, tags, sort }: Filter): Given[] {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const shown = rows.filter((row) => tags.every((tag) => row.tags.includes(tag)) && hasWords(row, words));
  const sign = sort.descending ? -1 : 1;
  return shown.sort((a, b) => sign * compared(a, b, sort.key) || byName(a, b));
}

/** The tags of rows, the most frequent first. */
export function tagsOf(rows: Row[]): string[] {
  const counts = new Map<string, number>();
  for (const tag of rows.flatMap((row) => row.tags)) counts.set(tag, (counts.get(tag) ?? 0) + 1);
  const found = [...counts].sort(([a, n], [b, m]) => m - n || a.localeCompare(b));
  return found.map(([tag]) => tag);
}

/** The tags in a string, in which commas separate them. */
export function readTags(text: string): string[] {
  const tags = text.split(",").map((tag) => tag.trim());
  return [...new Set(tags.filter((tag) => tag !== ""))];
}

function hasWords({ name, id, note, tags }: Row, words: string[]): boolean {
  if (words.length === 0) return true;
  const text = [name, id, note, ...tags].join("\n").toLowerCase();
  return words.every((word) => text.includes(word));
}

const collator = new Intl.Collator("en", { numeric: true });

function compared(a: Row, b: Row, key: SortKey): number {
  if (key === "date") return a.date_s - b.date_s;
  if (key === "size") return a.bytes - b.bytes;
  return key === "state" ? collator.compare(a.state, b.state) : byName(a, b);
}

function byName(a: Row, b: Row): number {
  return collator.compare(a.name, b.name) || collator.compare(a.id, b.id);
}

function readSort(text: string): Sort | null {
  const name = text.replace(/^-/, "");
  const key = sortKeys.find((each) => each === name);
  return key === undefined ? null : { key, descending: text.startsWith("-") };
}
