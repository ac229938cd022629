/** The current route: the part of the address after `#`. */
export class Route {
  hash = $state(location.hash);

  constructor() {
    addEventListener("hashchange", () => {
      this.hash = location.hash;
    });
  }

  get path(): string {
    return this.hash.replace(/^#/, "").split("?")[0] || "/";
  }

  get query(): URLSearchParams {
    const at = this.hash.indexOf("?");
    return new URLSearchParams(at < 0 ? "" : this.hash.slice(at + 1));
  }
}

export function goTo(hash: string): void {
  location.hash = hash;
}

/** Replaces the current route, so that going back skips it. */
export function replaceRoute(hash: string): void {
  location.replace(hash);
}
