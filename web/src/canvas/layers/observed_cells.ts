import { inWorld, type Layer, outline } from "./layer";

/** The cells that the selected robot's next decision would observe. */
export const observedCells: Layer = {
  id: "observed-cells",
  switch: { label: "Observed cells", on: true },
  place: "over",
  only: "classic",
  active: ({ robot }) => (robot?.examined_cells.length ?? 0) > 0,
  draw(pen, { robot, setting, selected }) {
    if (!robot || robot.name !== setting.robots[selected]) return;
    const { context, colours, camera } = pen;
    const path = new Path2D();
    for (const cell of robot.examined_cells) outline(path, cell);
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
