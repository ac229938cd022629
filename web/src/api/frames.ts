/** Frames: the moving objects at one tick. The arrays are views of the received buffer, not copies. */
import { FrameError } from "./frame_error";
import type { Overlay } from "./overlay";

export enum RobotState {
  Clear,
  InDanger,
  Collided,
  Empty,
  Broken,
}

export enum ItemState {
  Hidden,
  Found,
  Missed,
  Destroyed,
}

export interface Frame {
  generation: number;
  tick: number;
  time_s: number;
  /** Number to acknowledge with `got`. */
  number: number;
  /** Number of robots. */
  count: number;
  /** (count, 4): x and y in the unit of the world, heading in rad, state. */
  robots: Float32Array;
  /** One state per item. */
  items: Uint8Array;
  /** Present if layers were requested. */
  overlay?: Overlay | undefined;
}

const version = 1;
const headBytes = 32;
const robotBytes = 16;

/** Decodes a frame. Throws `FrameError` if the message is not a frame. */
export function readFrame(buffer: ArrayBuffer): Frame {
  if (buffer.byteLength < headBytes) throw new FrameError(`only ${buffer.byteLength} bytes`);
  const head = new DataView(buffer, 0, headBytes);
  if (head.getUint32(0, true) !== version) throw new FrameError("unsupported version");
  const count = head.getUint32(12, true);
  const items = head.getUint32(24, true);
  const robotsEnd = headBytes + robotBytes * count;
  if (buffer.byteLength !== robotsEnd + items) {
    throw new FrameError(`${buffer.byteLength} bytes for ${count} robots and ${items} items`);
  }
  return {
    generation: head.getUint32(4, true),
    tick: head.getUint32(8, true),
    time_s: head.getFloat64(16, true),
    number: head.getUint32(28, true),
    count,
    robots: new Float32Array(buffer, headBytes, 4 * count),
    items: new Uint8Array(buffer, robotsEnd, items),
  };
}
