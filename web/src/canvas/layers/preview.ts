import { inWorld, type Layer } from "./layer";

/** The shape that the current tool would place. */
export const preview: Layer = {
  id: "preview",
  place: "over",
  active: (scene) => scene.preview !== null,
  draw(pen, { preview: path }) {
    if (!path) return;
    const { context, colours, camera } = pen;
    inWorld(pen, () => {
      context.globalAlpha = 0.3;
      context.fillStyle = context.strokeStyle = colours.accent;
      context.fill(path);
      context.globalAlpha = 1;
      context.lineWidth = 2 / camera.scale;
      context.stroke(path);
    });
  },
};
