import type { Frame } from "../net/frames";
import type { Range } from "../run/robots";
import type { Camera } from "./camera";
import type { Colours } from "./colours";
import { PainterGl } from "./painter_gl";
import { Painter2d } from "./painter_2d";

/** Draws all robots of a frame. */
export interface Painter {
  /** How it draws: for people who ask why it is slow. */
  readonly name: string;
  setColours(colours: Colours): void;
  /** `fresh`: the frame is another one than last time. */
  paint(frame: Frame, ranges: Range[], camera: Camera, fresh: boolean): void;
  clear(): void;
}

/** Robots are drawn at least this long, tip to tail half, in pixels. */
export const leastRadius_px = 3;

export function painterFor(canvas: HTMLCanvasElement): Painter {
  const gl = canvas.getContext("webgl2", { antialias: false, alpha: true, depth: false, stencil: false });
  return gl ? new PainterGl(gl) : new Painter2d(canvas);
}
