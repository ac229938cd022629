import type { Json, Setting } from "../../api/protocol";
import { tableOf } from "../../shared/world";

/** The changes that were sent, until the server confirms or refuses them. */
export class SentChanges {
  private readonly values = new Map<string, Json>();

  sent(path: string, value: Json): void {
    this.values.set(path, value);
  }

  /** Forgets the changes that a setting contains: a value that was set already is logged nowhere. */
  confirm({ document, changes, log }: Pick<Setting, "document" | "changes" | "log">): void {
    const made = [...changes, ...(log ?? [])];
    for (const [path, value] of this.values) {
      const isLogged = made.some(([, at, logged]) => at === path && isSame(logged, value));
      if (isLogged || isSame(valueAt(document, path), value)) this.values.delete(path);
    }
  }

  /** Forgets a change that was refused; without a path, all. */
  forget(path: string | null = null): void {
    if (path === null) this.values.clear();
    else this.values.delete(path);
  }

  /** The paths of the changes that are neither confirmed nor refused, which are then forgotten. */
  takeUnconfirmed(): string[] {
    const paths = [...this.values.keys()];
    this.values.clear();
    return paths;
  }
}

function valueAt(document: Setting["document"], path: string): Json | undefined {
  return path.split(".").reduce<Json | undefined>((table, key) => tableOf(table)[key], document);
}

function isSame(one: Json | undefined, other: Json): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}
