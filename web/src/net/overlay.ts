/** Overlays: what lies over a frame besides robots, at the same tick, of the layers that were asked for. */
import { FrameFault } from "./frames";

/** What a sensor covers: its sector, as far as nothing hides it. */
export interface Footprint {
  /** Number of the robot. */
  robot: number;
  findsItems: boolean;
  range_m: number;
  width_rad: number;
  facing_rad: number;
  /** How far it sees along bearings that are evenly spread over the sector; empty if nothing cuts it. */
  ranges_m: Float32Array;
}

export interface Overlay {
  /** Number of the frame that it lies over. */
  frame: number;
  /** (links, 3): the robot that is heard, the one that hears, and 1 if both hear each other. */
  links: Uint32Array;
  footprints: Footprint[];
}

export const overlayKind = 2;
const headBytes = 12;
const linkBytes = 12;
const footprintBytes = 24;

/** The overlay in a message; throws `FrameFault` for what is none. */
export function readOverlay(buffer: ArrayBuffer): Overlay {
  if (buffer.byteLength < headBytes) throw new FrameFault(`only ${buffer.byteLength} bytes`);
  const [kind, frame = 0, count = 0] = new Uint32Array(buffer, 0, 3);
  if (kind !== overlayKind) throw new FrameFault("no overlay");
  const linksEnd = headBytes + linkBytes * count;
  if (buffer.byteLength < linksEnd) throw new FrameFault(`${buffer.byteLength} bytes for ${count} links`);
  const links = new Uint32Array(buffer, headBytes, 3 * count);
  return { frame, links, footprints: [...footprintsIn(buffer, linksEnd)] };
}

function* footprintsIn(buffer: ArrayBuffer, start: number): Generator<Footprint> {
  let at = start;
  while (at < buffer.byteLength) {
    const left = buffer.byteLength - at;
    if (left < footprintBytes) throw new FrameFault(`${left} bytes left for a footprint`);
    const [robot = 0, findsItems, ranges = 0] = new Uint32Array(buffer, at, 3);
    const [range_m = 0, width_rad = 0, facing_rad = 0] = new Float32Array(buffer, at + 12, 3);
    const end = at + footprintBytes + 4 * ranges;
    if (end > buffer.byteLength) throw new FrameFault(`${left} bytes left for ${ranges} ranges`);
    const ranges_m = new Float32Array(buffer, at + footprintBytes, ranges);
    yield { robot, findsItems: findsItems === 1, range_m, width_rad, facing_rad, ranges_m };
    at = end;
  }
}
