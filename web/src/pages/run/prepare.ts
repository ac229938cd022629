import type { Link } from "../../shared/link";
import { unpack } from "../../shared/packed_text";
import { Viewer } from "./viewer.svelte";

/** The run of an address; null if its scenario cannot be unpacked. */
export async function prepare(link: Link): Promise<Viewer | null> {
  const text = link.text === null ? null : await unpack(link.text);
  return text === null && link.text !== null ? null : new Viewer(link, text);
}
