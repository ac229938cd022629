import { type Link, longestLink, writeLink } from "../../shared/link";
import { isKept } from "../../shared/packed_text";
import type { Session } from "./session.svelte";
import type { Viewer } from "./viewer.svelte";

const most_ms = 1000;
const rest_ms = 2000;

/** Keeps the page's address that of what is seen: at most once a second, and once more when it rests. */
export function keepAddress(viewer: Viewer): void {
  const names = new RecordedNames(viewer);
  let timer: ReturnType<typeof setTimeout> | undefined;
  let written = 0;

  function write(): void {
    timer = undefined;
    const link = viewer.now;
    const hash = writeLink(link);
    const isTooMuch = hash.length > longestLink || isKept(link.text);
    const kept = isTooMuch ? names.hash(link) : hash;
    if (kept === null) timer = setTimeout(write, rest_ms);
    if (!kept || kept === location.hash) return;
    written = performance.now();
    history.replaceState(history.state, "", kept);
  }

  $effect(() => {
    void [viewer.now, viewer.session.saved];
    timer ??= setTimeout(write, Math.max(50, written + most_ms - performance.now()));
  });
  $effect(() => () => clearTimeout(timer));
}

/** Addresses of runs of which an address does not hold all: their recordings' names stand for it. */
export class RecordedNames {
  private seen = "";
  private tried = "";

  constructor(private readonly viewer: Pick<Viewer, "session">) {}

  /** The address; null as long as changes are still made, empty until there is a recording. */
  hash(link: Link): string | null {
    const { session } = this.viewer;
    const key = session.changesKey;
    const named = session.saved && recorded(link, session.saved, key);
    if (named && named.length <= longestLink) return named;
    const rests = this.seen === key;
    this.seen = key;
    if (!rests || session.saving) return null;
    // What was refused is not tried again before something changes.
    if (this.tried !== key) session.save();
    this.tried = key;
    return "";
  }
}

/** The address by a recording's name, with all changes if they are not the recording's. */
function recorded(link: Link, saved: NonNullable<Session["saved"]>, key: string): string {
  const changes = saved.changes === key ? null : link.changes;
  const { id } = saved.recording;
  return writeLink({ ...link, scenario: null, text: null, study: null, recording: id, changes });
}
