import { toScreen } from "../camera";
import type { Layer, Pen, Scene } from "./layer";

/** The ground of the world. */
export const ground: Layer = {
  id: "ground",
  place: "still",
  active: () => true,
  draw(pen, scene) {
    pen.context.fillStyle = pen.colours.ground;
    pen.context.fillRect(...rectangle(pen, scene));
  },
};

/** The border of the world; dashed if the world is periodic. */
export const border: Layer = {
  id: "border",
  place: "still",
  active: () => true,
  draw(pen, scene) {
    const { context, colours } = pen;
    context.strokeStyle = colours.border;
    context.lineWidth = scene.world.periodic ? 1 : 2;
    context.setLineDash(scene.world.periodic ? [6, 4] : []);
    context.strokeRect(...rectangle(pen, scene));
    context.setLineDash([]);
  },
};

function rectangle({ camera }: Pen, { world }: Scene): [number, number, number, number] {
  const [left, top] = toScreen(camera, 0, world.size[1]);
  return [left, top, world.size[0] * camera.scale, world.size[1] * camera.scale];
}
