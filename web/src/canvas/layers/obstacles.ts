import { inWorld, type Layer, shape } from "./layer";

/** Polygons and circles; the layer `maps` draws maps. */
export const obstacles: Layer = {
  id: "obstacles",
  place: "still",
  active: ({ world }) => world.shapes.length > 0,
  draw(pen, { world }) {
    const { context, colours, camera } = pen;
    const path = new Path2D();
    for (const one of world.shapes) shape(path, one);
    inWorld(pen, () => {
      context.fillStyle = colours.obstacle;
      context.fill(path);
      context.strokeStyle = colours["obstacle-edge"];
      context.lineWidth = 1 / camera.scale;
      context.stroke(path);
    });
  },
};
