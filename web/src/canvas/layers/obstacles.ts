import { circleOf, polygonOf } from "../../shared/world";
import { inWorld, type Layer, outline, ring } from "./layer";

/** Polygons and circles; the layer `maps` draws maps. */
export const obstacles: Layer = {
  id: "obstacles",
  place: "still",
  active: ({ world }) => world.obstacles.length > 0,
  draw(pen, { world }) {
    const { context, colours, camera } = pen;
    const path = new Path2D();
    for (const obstacle of world.obstacles) {
      const [polygon, circle] = [polygonOf(obstacle), circleOf(obstacle)];
      if (polygon) outline(path, polygon);
      if (circle) ring(path, circle.at_m, circle.radius_m);
    }
    inWorld(pen, () => {
      context.fillStyle = colours.obstacle;
      context.fill(path);
      context.strokeStyle = colours["obstacle-edge"];
      context.lineWidth = 1 / camera.scale;
      context.stroke(path);
    });
  },
};
