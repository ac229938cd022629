import type { Frame } from "../api/frames";
import type { Range } from "../shared/robots";
import type { Box } from "./backdrop";
import type { Camera } from "./camera";
import type { Colours } from "./colours";

/** Draws all robots of a frame. */
export interface Painter {
  /** Whether there is no graphics card; 2D canvases are faster in main memory then. */
  readonly isSoftware: boolean;
  setColours(colours: Colours): void;
  /** Sets the picture below the robots, and the box of plain ground in it. */
  setStill(still: CanvasRenderingContext2D, ground: Box): void;
  /** Draws a frame, or only the still picture without one. `fresh`: the frame has changed. */
  paint(frame: Frame | null, ranges: Range[], camera: Camera, fresh: boolean): void;
}

/** Minimum radius of a drawn robot in pixels, so that it is seen at any scale: larger for few robots than for many. */
export function minRadius_px(robots: number): number {
  if (robots <= 200) return 7;
  return robots <= 2000 ? 4 : 3;
}

/** The radius at which a robot is drawn, in the unit of the world. */
export function drawnRadius(radius: number, camera: Camera, robots: number): number {
  return Math.max(radius, minRadius_px(robots) / camera.scale);
}
