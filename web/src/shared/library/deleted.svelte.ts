import type { Deleted } from "../../api/protocol";

const key = "deleted";

/** The last deletion, which can be undone until it is dismissed; it survives a reload. */
class LastDeletion {
  last = $state.raw<Deleted | null>(stored());

  set(last: Deleted | null): void {
    this.last = last;
    try {
      if (last) sessionStorage.setItem(key, JSON.stringify(last));
      else sessionStorage.removeItem(key);
    } catch {
      // A browser without storage keeps it until the page is closed.
    }
  }
}

function stored(): Deleted | null {
  try {
    return JSON.parse(sessionStorage.getItem(key) ?? "null") as Deleted | null;
  } catch {
    return null;
  }
}

export const deletion = new LastDeletion();
