/** Overlays: sensor footprints and radio links at the tick of a frame, for the requested layers. */
import { FrameError } from "./frame_error";

/** The area that a sensor covers: its sector, cut by occlusions. */
export interface Footprint {
  /** Number of the robot. */
  robot: number;
  findsItems: boolean;
  /** The maximum range of the sensor. */
  range_m: number;
  /**
   * (corners, 2): bearing in the robot's frame in rad, ascending, and distance. Two corners at full range are
   * joined by an arc, others by a straight line.
   */
  corners: Float32Array;
}

export interface Overlay extends OverlayData {
  /** The robots of its frame. Drawn robots may be between this frame and the next. */
  robots: Float32Array;
}

/** An overlay as received. */
export interface OverlayData {
  /** Number of the frame that it belongs to. */
  frame: number;
  /** (links, 3): sender, receiver, and 1 if the link is two-way. */
  links: Uint32Array;
  footprints: Footprint[];
}

/** Above this number of links, the server sends those of the selected robot and a part of the others. */
export const maxLinks = 4000;
export const overlayKind = 2;
const headBytes = 12;
const linkBytes = 12;
const footprintBytes = 16;
const cornerBytes = 8;

/** Decodes an overlay. Throws `FrameError` if the message is not an overlay. */
export function readOverlay(buffer: ArrayBuffer): OverlayData {
  if (buffer.byteLength < headBytes) throw new FrameError(`only ${buffer.byteLength} bytes`);
  const [kind, frame = 0, count = 0] = new Uint32Array(buffer, 0, 3);
  if (kind !== overlayKind) throw new FrameError("not an overlay");
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
