import type { Painter } from "./painter";
import { Painter2d } from "./painter_2d";
import { PainterGl } from "./painter_gl";

export function painterFor(canvas: HTMLCanvasElement): Painter {
  const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, depth: false, stencil: false });
  return gl ? new PainterGl(gl) : new Painter2d(canvas);
}
