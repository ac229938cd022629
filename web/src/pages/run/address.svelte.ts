import { type Link, maxLinkLength, writeLink } from "../../shared/link";
import { isStoredInTab } from "../../shared/packed_text";
import type { Session } from "./session.svelte";
import type { Viewer } from "./viewer.svelte";

const interval_ms = 1000;
const retry_ms = 2000;

/** Keeps the address of the page up to date, at most once per second. */
export function keepAddress(viewer: Viewer): void {
  const names = new RecordedNames(viewer);
  let timer: ReturnType<typeof setTimeout> | undefined;
  let written = 0;
  let own = location.hash;

  function write(): void {
    timer = undefined;
    // The user has just opened another page, which is about to replace this one.
    if (location.hash !== own) return;
    const link = viewer.currentLink;
    const hash = writeLink(link);
    const isTooLong = hash.length > maxLinkLength || isStoredInTab(link.text);
    const kept = isTooLong ? names.hash(link) : hash;
    if (kept === null) timer = setTimeout(write, retry_ms);
    if (!kept || kept === location.hash) return;
    written = performance.now();
    history.replaceState(history.state, "", kept);
    own = location.hash;
  }

  $effect(() => {
    void [viewer.currentLink, viewer.session.saved];
    timer ??= setTimeout(write, Math.max(50, written + interval_ms - performance.now()));
  });
  $effect(() => () => clearTimeout(timer));
}

/** Addresses of runs that do not fit into an address: they name a recording, which is saved if necessary. */
export class RecordedNames {
  private seen = "";
  private attempted = "";

  constructor(private readonly viewer: Pick<Viewer, "session">) {}

  /** The address; null while changes are still being made, empty until there is a recording. */
  hash(link: Link): string | null {
    const { session } = this.viewer;
    const key = session.changesKey;
    const named = session.saved && recorded(link, session.saved, key);
    if (named && named.length <= maxLinkLength) return named;
    const isUnchanged = this.seen === key;
    this.seen = key;
    if (!isUnchanged || session.saving) return null;
    // After a failure, saving is not attempted again until something changes.
    if (this.attempted !== key) session.save();
    this.attempted = key;
    return "";
  }
}

/** The address with a recording's name, and with all changes if they differ from the recording's. */
function recorded(link: Link, saved: NonNullable<Session["saved"]>, key: string): string {
  const changes = saved.changes === key ? null : link.changes;
  const { id } = saved.recording;
  return writeLink({ ...link, scenario: null, text: null, study: null, recording: id, changes });
}
