import { inWorld, type Layer, outline } from "./layer";

/** The cells that the selected robot would look at if it decided now. */
export const looks: Layer = {
  id: "looks",
  label: "Cells looked at",
  switchable: true,
  on: true,
  place: "over",
  only: "classic",
  active: ({ told }) => (told?.looks.length ?? 0) > 0,
  draw(pen, { told, setting, selected }) {
    if (!told || told.name !== setting.robots[selected]) return;
    const { context, colours, camera } = pen;
    const path = new Path2D();
    for (const cell of told.looks) outline(path, cell);
    inWorld(pen, () => {
      context.globalAlpha = 0.16;
      context.fillStyle = context.strokeStyle = colours["sense-items"];
      context.fill(path);
      context.globalAlpha = 0.7;
      context.lineWidth = 1 / camera.scale;
      context.stroke(path);
    });
  },
};
