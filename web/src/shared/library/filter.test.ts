import { describe, expect, it } from "vitest";
import { type Filter, readFilter, readTags, type Row, tagsOf, visibleRows, writeFilter } from "./filter";

const usual = { key: "date", descending: true } as const;
const all: Filter = { text: "", tags: [], sort: usual };

function row(id: string, values: Partial<Row> = {}): Row {
  return { id, name: id, note: "", tags: [], bytes: 1, date_s: 1, state: "Answered", ...values };
}

const ids = (rows: Row[]) => rows.map(({ id }) => id);

describe("the filter of a list", () => {
  it("finds all of its words in the title, the id, the note and the tags, in any case", () => {
    const rows = [
      row("studies/a", { name: "Wind at sea" }),
      row("studies/wind"),
      row("studies/b", { note: "the WIND\nturns" }),
      row("studies/c", { tags: ["Wind"] }),
      row("studies/d"),
    ];
    expect(ids(visibleRows(rows, { ...all, text: " wind " })).sort()).toEqual([
      "studies/a",
      "studies/b",
      "studies/c",
      "studies/wind",
    ]);
    expect(ids(visibleRows(rows, { ...all, text: "wind sea" }))).toEqual(["studies/a"]);
  });

  it("lets through what has all chosen tags", () => {
    const rows = [row("a", { tags: ["x", "y"] }), row("b", { tags: ["x"] }), row("c")];
    expect(ids(visibleRows(rows, { ...all, tags: ["x"] }))).toEqual(["a", "b"]);
    expect(ids(visibleRows(rows, { ...all, tags: ["x", "y"] }))).toEqual(["a"]);
  });

  it("sorts by each key in both directions, and equal rows by name", () => {
    const rows = [
      row("b", { bytes: 3, date_s: 1, state: "Stopped" }),
      row("a10", { bytes: 1, date_s: 3, state: "Answered" }),
      row("a9", { bytes: 1, date_s: 2, state: "Stopped" }),
    ];
    const sorted = (key: Filter["sort"]["key"], descending: boolean) =>
      ids(visibleRows(rows, { ...all, sort: { key, descending } }));
    expect(sorted("name", false)).toEqual(["a9", "a10", "b"]);
    expect(sorted("name", true)).toEqual(["b", "a10", "a9"]);
    expect(sorted("date", true)).toEqual(["a10", "a9", "b"]);
    expect(sorted("size", false)).toEqual(["a9", "a10", "b"]);
    expect(sorted("size", true)).toEqual(["b", "a9", "a10"]);
    expect(sorted("state", false)).toEqual(["a10", "a9", "b"]);
  });

  it("survives an address", () => {
    const filter: Filter = {
      text: "a b&c=%2f#?",
      tags: ["x y", "Größe"],
      sort: { key: "size", descending: false },
    };
    const hash = writeFilter("#/studies?filter=old", filter, usual);
    expect(readFilter(hash, usual)).toEqual(filter);
    expect(writeFilter(hash, all, usual)).toBe("#/studies");
    expect(writeFilter("", all, usual)).toBe("#/");
  });

  it("ignores what is no filter in an address", () => {
    expect(readFilter("#/studies?sort=colour&tag=a&tag=a", usual)).toEqual({ ...all, tags: ["a"] });
  });

  it("takes less than 50 ms for a thousand entries", () => {
    const rows = Array.from({ length: 1000 }, (_, i) =>
      row(`studies/${i}`, { note: "x".repeat(1000), date_s: i }),
    );
    const begin = performance.now();
    expect(visibleRows(rows, { ...all, text: "studies/99" })).toHaveLength(11);
    expect(performance.now() - begin).toBeLessThan(50);
  });
});

describe("tags", () => {
  it("are separated by commas, each once", () => {
    expect(readTags(" a, b c,,a ,")).toEqual(["a", "b c"]);
  });

  it("are listed by their number of entries", () => {
    expect(
      tagsOf([row("1", { tags: ["b", "c"] }), row("2", { tags: ["c"] }), row("3", { tags: ["a"] })]),
    ).toEqual(["c", "a", "b"]);
  });
});
