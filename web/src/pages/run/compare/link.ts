import { type Link, damagesOf, readLink, writeLink } from "../../../shared/link";

const run = "#/run?";

/** The address of two runs side by side. */
export function compareLink(left: Link, right: Link): string {
  const query = (link: Link) => encodeURIComponent(writeLink({ ...link, view: null }).slice(run.length));
  return `#/compare?left=${query(left)}&right=${query(right)}`;
}

/** The two runs of an address, or what is wrong with it. */
export function readCompareLink(query: URLSearchParams): { left: Link; right: Link } | { damages: string[] } {
  const sides = ["left", "right"].map((side) => new URLSearchParams(query.get(side) ?? ""));
  const damages = sides.flatMap((side, i) =>
    damagesOf(side).map((line) => `${i === 0 ? "left" : "right"}: ${line}`),
  );
  const [left, right] = sides.map(readLink);
  if (damages.length > 0 || !left || !right) return { damages };
  if (left.live || right.live) return { damages: ["live: a live run cannot be compared"] };
  return { left, right };
}

/** The run of an address that a person has copied, such as `http://127.0.0.1:8765/#/run?scenario=search`. */
export function linkIn(address: string): Link | null {
  const at = address.indexOf(run);
  if (at < 0) return null;
  const query = new URLSearchParams(address.slice(at + run.length).trim());
  return damagesOf(query).length > 0 ? null : readLink(query);
}
