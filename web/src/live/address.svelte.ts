import { type Link, longestLink, writeLink } from "../run/link";

const most_ms = 1000;

/** Keeps the page's address that of what is seen: at most once a second, and once more when it rests. */
export function keepAddress(now: () => Link): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let written = 0;

  function write(): void {
    timer = undefined;
    const hash = writeLink(now());
    // A longer address would lose its end on its way, and give another run.
    if (hash.length > longestLink || hash === location.hash) return;
    written = performance.now();
    history.replaceState(history.state, "", hash);
  }

  $effect(() => {
    now();
    timer ??= setTimeout(write, Math.max(50, written + most_ms - performance.now()));
  });
  $effect(() => () => clearTimeout(timer));
}
