/** Where in the page one is: what stands behind `#` in its address. */
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

/** Goes on from what is closed by that: the way back leads past it. */
export function goOn(hash: string): void {
  location.replace(hash);
}
