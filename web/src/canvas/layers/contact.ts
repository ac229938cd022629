import { inWorld, type Layer, outline } from "./layer";

/** The areas in which robots find items. */
export const contact: Layer = {
  id: "contact",
  switch: { label: "Detection areas", on: true },
  place: "still",
  only: "classic",
  active: ({ setting }) => setting.items.some((item) => item.contact.length > 0),
  draw(pen, { setting }) {
    const { context, colours } = pen;
    const path = new Path2D();
    for (const cell of setting.items.flatMap((item) => item.contact)) outline(path, cell);
    inWorld(pen, () => {
      context.globalAlpha = 0.14;
      context.fillStyle = colours["item-hidden"];
      context.fill(path);
    });
  },
};
