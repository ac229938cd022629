import type { Point } from "../../api/protocol";
import { imagesOf, type Layer, poseOf, type Scene, shortestWay, withinWorld } from "./layer";

/** Radio links as reported by the engine: solid if two-way, dashed if one-way. */
export const links: Layer = {
  id: "links",
  switch: { label: "Radio links", on: false },
  place: "over",
  only: "metric",
  active: ({ frame }) => (frame?.overlay?.links.length ?? 0) > 0,
  draw(pen, scene) {
    const { context, colours, camera } = pen;
    const [mutual, single] = [new Path2D(), new Path2D()];
    const links = scene.frame?.overlay?.links ?? new Uint32Array();
    for (let i = 0; i < links.length; i += 3) {
      const [from, to] = [poseOf(scene, links[i] ?? -1), poseOf(scene, links[i + 1] ?? -1)];
      if (from && to) connect(links[i + 2] === 1 ? mutual : single, scene, from.at, to.at);
    }
    withinWorld(pen, scene, () => {
      context.strokeStyle = colours.link;
      context.lineWidth = 1 / camera.scale;
      context.stroke(mutual);
      context.setLineDash([4 / camera.scale, 4 / camera.scale]);
      context.stroke(single);
    });
  },
};

function connect(path: Path2D, scene: Scene, from: Point, to: Point): void {
  const [x, y] = shortestWay(scene, from, to);
  for (const [startX, startY] of imagesOf(scene, from, Math.max(Math.abs(x), Math.abs(y)))) {
    path.moveTo(startX, startY);
    path.lineTo(startX + x, startY + y);
  }
}
