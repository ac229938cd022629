import type { Frame } from "../api/frames";
import type { Range } from "../shared/robots";
import type { Box } from "./backdrop";
import type { Camera } from "./camera";
import type { Colours } from "./colours";

/** Draws all robots of a frame. */
export interface Painter {
  /** Whether there is no graphics card: what is drawn on canvases is best kept in memory then. */
  readonly isSoftware: boolean;
  setColours(colours: Colours): void;
  /** What is beneath the robots, and where in it the plain ground is. */
  setStill(still: CanvasRenderingContext2D, ground: Box): void;
  /** `fresh`: the frame is another one than last time; without one, only what stands still. */
  paint(frame: Frame | null, ranges: Range[], camera: Camera, fresh: boolean): void;
}

/** Half the length at least, in pixels, at which robots are drawn; a few can be larger than a crowd. */
export function leastRadius_px(robots: number): number {
  return robots <= 200 ? 5 : 3;
}

/** The radius at which a robot is drawn, in the unit of the world. */
export function drawnRadius(radius: number, camera: Camera, robots: number): number {
  return Math.max(radius, leastRadius_px(robots) / camera.scale);
}
