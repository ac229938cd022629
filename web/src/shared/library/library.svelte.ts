import { tick } from "svelte";
import * as api from "../../api/library";
import type { LibraryEntry } from "../../api/protocol";
import { errorText } from "../error_text";
import { deletion } from "./deleted.svelte";
import { type Filter, readFilter, type Row, type Sort, writeFilter } from "./filter";

/** Entries that are drawn at first: those of a thousand would delay each key press. */
const firstRows = 200;

/** What is edited in a dialog. */
export type Edited = "title" | "note";

/** The titles, notes, tags and sizes of a list, its filter, and what is done to its entries. */
export class Library {
  entries = $state.raw<ReadonlyMap<string, LibraryEntry>>(new Map());
  filter = $state.raw<Filter>() as Filter;
  /** Entries that are drawn at most. */
  limit = $state(firstRows);
  /** The entry in a dialog. */
  edited = $state.raw<{ row: Row; what: Edited } | null>(null);
  /** What is being done, such as "Duplicating search". */
  doing = $state("");
  failure = $state("");

  constructor(
    readonly kind: api.LibraryKind,
    readonly usual: Sort,
    /** Loads the list itself again. */
    private readonly reload: () => Promise<void>,
  ) {
    this.readAddress();
  }

  readAddress(): void {
    this.filter = readFilter(location.hash, this.usual);
  }

  /** Changes the filter, also in the address, so that it survives a reload and going back. */
  show(changed: Partial<Filter>): void {
    this.filter = { ...this.filter, ...changed };
    this.limit = firstRows;
    history.replaceState(history.state, "", writeFilter(location.hash, this.filter, this.usual));
  }

  async refresh(): Promise<void> {
    try {
      const entries = await api.libraryEntries(this.kind);
      this.entries = new Map(entries.map((entry) => [entry.id, entry]));
    } catch (error) {
      this.failure = errorText(error);
    }
  }

  /** An entry as a row of the list; `name` is what the list calls it without a title. */
  row(id: string, name: string, date_s: number, state: string): Row {
    const entry = this.entries.get(id);
    return {
      id,
      name: entry?.title || name,
      note: entry?.note ?? "",
      tags: entry?.tags ?? [],
      bytes: entry?.bytes ?? 0,
      date_s,
      state,
    };
  }

  /** Closes the dialog; the entry's actions have the focus again. */
  close(): void {
    const id = this.edited?.row.id;
    this.edited = null;
    if (id !== undefined) void this.focusActions(id);
  }

  /** Sets the label of the entry in the dialog; returns the error, or an empty string. */
  async save(label: Partial<api.Label>): Promise<string> {
    const id = this.edited?.row.id;
    if (id === undefined) return "";
    try {
      const entry = await api.setLabel(this.kind, id, label);
      this.entries = new Map(this.entries).set(id, entry);
    } catch (error) {
      return errorText(error);
    }
    this.close();
    return "";
  }

  async duplicate({ id, name }: Row): Promise<void> {
    await this.do(`Duplicating ${name}…`, async () => {
      const copy = await api.duplicate(this.kind, id);
      await this.reloadAll();
      await this.focusActions(copy.id);
    });
  }

  async delete({ id, name }: Row): Promise<void> {
    await this.do(`Deleting ${name}…`, async () => {
      const deleted = await api.moveToTrash(this.kind, id);
      deletion.set({ ...deleted, title: name });
      await this.reloadAll();
      document.getElementById("undo")?.focus();
    });
  }

  async undo(): Promise<void> {
    const { last } = deletion;
    if (last === null) return;
    await this.do(`Restoring ${last.title}…`, async () => {
      const { id } = await api.restore(last.token);
      deletion.set(null);
      await this.reloadAll();
      await this.focusActions(id);
    });
  }

  dismiss(): void {
    deletion.set(null);
    document.getElementById("filter")?.focus();
  }

  private async do(doing: string, work: () => Promise<void>): Promise<void> {
    if (this.doing !== "") return;
    this.doing = doing;
    this.failure = "";
    try {
      await work();
    } catch (error) {
      this.failure = errorText(error);
    } finally {
      this.doing = "";
    }
  }

  /** Focuses the actions of an entry, or the filter if it does not let the entry through. */
  private async focusActions(id: string): Promise<void> {
    await tick();
    if (actionsOf(id) === null) {
      this.limit = Infinity;
      await tick();
    }
    (actionsOf(id) ?? document.getElementById("filter"))?.focus();
  }

  private async reloadAll(): Promise<void> {
    await Promise.all([this.reload(), this.refresh()]);
    await tick();
  }
}

function actionsOf(id: string): HTMLElement | null {
  return document.querySelector(`[data-actions="${CSS.escape(id)}"]`);
}
