/** Overlays: what lies over a frame besides robots, at the same tick, of the layers that were asked for. */
import { FrameError } from "./frame_error";

/** What a sensor covers: its sector, as far as nothing hides it. */
export interface Footprint {
  /** Number of the robot. */
  robot: number;
  findsItems: boolean;
  /** As far as it sees at all. */
  range_m: number;
  /**
   * (corners, 2): of its outline, bearing from the robot's front in rad, ascending, and distance. Between two at
   * full range lies an arc, between others a straight line.
   */
  corners: Float32Array;
}

export interface Overlay extends Told {
  /** The robots of the frame that it lies over: those in the picture may be on their way to the next. */
  robots: Float32Array;
}

/** An overlay as it comes. */
export interface Told {
  /** Number of the frame that it lies over. */
  frame: number;
  /** (links, 3): the robot that is heard, the one that hears, and 1 if both hear each other. */
  links: Uint32Array;
  footprints: Footprint[];
}

/** If there are more links than this, those of the selected robot are told, and some others. */
export const mostLinks = 4000;
export const overlayKind = 2;
const headBytes = 12;
const linkBytes = 12;
const footprintBytes = 16;
const cornerBytes = 8;

/** The overlay in a message; throws `FrameError` for what is none. */
export function readOverlay(buffer: ArrayBuffer): Told {
  if (buffer.byteLength < headBytes) throw new FrameError(`only ${buffer.byteLength} bytes`);
  const [kind, frame = 0, count = 0] = new Uint32Array(buffer, 0, 3);
  if (kind !== overlayKind) throw new FrameError("no overlay");
  const linksEnd = headBytes + linkBytes * count;
  if (buffer.byteLength < linksEnd) throw new FrameError(`${buffer.byteLength} bytes for ${count} links`);
  const links = new Uint32Array(buffer, headBytes, 3 * count);
  return { frame, links, footprints: [...footprintsIn(buffer, linksEnd)] };
}

function* footprintsIn(buffer: ArrayBuffer, start: number): Generator<Footprint> {
  let at = start;
  while (at < buffer.byteLength) {
    const left = buffer.byteLength - at;
    if (left < footprintBytes) throw new FrameError(`${left} bytes left for a footprint`);
    const [robot = 0, findsItems, count = 0] = new Uint32Array(buffer, at, 3);
    const [range_m = 0] = new Float32Array(buffer, at + 12, 1);
    const end = at + footprintBytes + cornerBytes * count;
    if (end > buffer.byteLength) throw new FrameError(`${left} bytes left for ${count} corners`);
    const corners = new Float32Array(buffer, at + footprintBytes, 2 * count);
    yield { robot, findsItems: findsItems === 1, range_m, corners };
    at = end;
  }
}
