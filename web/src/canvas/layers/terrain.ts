import { toScreen } from "../camera";
import { inWorld, type Layer, outline } from "./layer";

/** Terrain classes with their names. */
export const terrain: Layer = {
  id: "terrain",
  switch: { label: "Terrain", on: true },
  place: "still",
  only: "metric",
  active: ({ world }) => world.terrain.length > 0,
  draw(pen, { world }) {
    const { context, colours, camera } = pen;
    for (const { name, areas_m } of world.terrain) {
      const path = new Path2D();
      for (const area of areas_m) outline(path, area);
      inWorld(pen, () => {
        context.fillStyle = colours.terrain;
        context.fill(path);
        context.strokeStyle = colours["terrain-text"];
        context.globalAlpha = 0.5;
        context.lineWidth = 1 / camera.scale;
        context.setLineDash([2 / camera.scale, 4 / camera.scale]);
        context.stroke(path);
      });
      context.fillStyle = colours["terrain-text"];
      context.font = "12px system-ui, sans-serif";
      for (const [corner] of areas_m.map((area) => [...area].sort((a, b) => b[1] - a[1] || a[0] - b[0]))) {
        if (!corner) continue;
        const [x, y] = toScreen(camera, ...corner);
        context.fillText(name, x + 8, y + 18);
      }
    }
  },
};
