import type { Deleted, LibraryEntry, LibraryList } from "./protocol";
import { postJson, request } from "./http";

/** The kinds of entries of the library, as in its addresses. */
export type LibraryKind = "studies" | "recordings" | "scenarios";

/** What the user calls and notes of an entry. */
export type Label = Pick<LibraryEntry, "title" | "note" | "tags">;

/** Titles, notes, tags and sizes of all entries of a kind. */
export async function libraryEntries(kind: LibraryKind): Promise<LibraryEntry[]> {
  const response = await request(`api/library/${kind}`);
  return ((await response.json()) as LibraryList).entries;
}

export async function libraryEntry(kind: LibraryKind, id: string): Promise<LibraryEntry> {
  const response = await request(`api/library/${kind}/entry?${new URLSearchParams({ id })}`);
  return (await response.json()) as LibraryEntry;
}

export function setLabel(kind: LibraryKind, id: string, label: Partial<Label>): Promise<LibraryEntry> {
  return postJson(`api/library/${kind}/label`, { id, ...label });
}

export function duplicate(kind: LibraryKind, id: string): Promise<LibraryEntry> {
  return postJson(`api/library/${kind}/duplicate`, { id });
}

export function moveToTrash(kind: LibraryKind, id: string): Promise<Deleted> {
  return postJson(`api/library/${kind}/delete`, { id });
}

export function restore(token: string): Promise<Deleted> {
  return postJson("api/library/undo", { token });
}
