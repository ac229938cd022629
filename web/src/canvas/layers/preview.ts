import { inWorld, type Layer } from "./layer";

/** What is being put somewhere by hand. */
export const ghost: Layer = {
  id: "ghost",
  label: "Editing",
  switchable: false,
  on: true,
  place: "over",
  active: (scene) => scene.ghost !== null,
  draw(pen, { ghost: path }) {
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
