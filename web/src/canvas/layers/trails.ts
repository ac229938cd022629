import { inWorld, type Layer } from "./layer";

const bands = 4;

/** Robot positions of the last seconds, fading with age. */
export const trails: Layer = {
  id: "trails",
  switch: { label: "Trails", on: true },
  place: "over",
  active: ({ trails: kept }) => !kept.isEmpty,
  draw(pen, { trails: kept, world }) {
    const { context, colours, camera } = pen;
    const samples = kept.inOrder();
    const size = samples[0] ? samples[0].places.length / 2 : 0;
    const jump = world.periodic ? Math.min(...world.size) / 2 : Number.POSITIVE_INFINITY;
    const paths = Array.from({ length: bands }, () => new Path2D());
    for (let robot = 0; robot < size; robot++) {
      for (let i = 1; i < samples.length; i++) {
        const [from, to] = [samples[i - 1]?.places, samples[i]?.places];
        const path = paths[Math.floor((i * bands) / samples.length)];
        if (from && to && path) segment(path, from, to, robot, jump);
      }
    }
    inWorld(pen, () => {
      context.strokeStyle = colours.trail;
      context.lineWidth = 1.5 / camera.scale;
      paths.forEach((path, band) => {
        context.globalAlpha = (0.7 * (band + 1)) / bands;
        context.stroke(path);
      });
    });
  },
};

function segment(path: Path2D, from: Float32Array, to: Float32Array, robot: number, jump: number): void {
  const [ax = 0, ay = 0] = [from[2 * robot], from[2 * robot + 1]];
  const [bx = 0, by = 0] = [to[2 * robot], to[2 * robot + 1]];
  if (Math.abs(ax - bx) > jump || Math.abs(ay - by) > jump) return;
  path.moveTo(ax, ay);
  path.lineTo(bx, by);
}
