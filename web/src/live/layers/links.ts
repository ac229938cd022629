import type { Frame } from "../../net/frames";
import { kindOf, rangesOf } from "../../run/robots";
import { inWorld, type Layer, type Scene } from "./layer";

/** Of more robots than this only the selected one's links are drawn. */
const most = 300;
const mostLinks = 4000;

/** Robots within each other's radio range; walls that silence radios are not looked at. */
export const links: Layer = {
  id: "links",
  label: "Radio range",
  switchable: true,
  on: false,
  place: "over",
  only: "metric",
  active: ({ setting, frame, selected }) =>
    setting.kinds.some((kind) => kind.radio_range_m !== null) &&
    frame !== null &&
    (frame.count <= most || selected >= 0),
  draw(pen, scene) {
    const { context, colours, camera } = pen;
    const path = new Path2D();
    const { frame } = scene;
    if (frame && frame.count > most) fromOne(path, scene, frame);
    else if (frame) connect(path, scene, frame);
    inWorld(pen, () => {
      context.strokeStyle = colours.link;
      context.lineWidth = 1 / camera.scale;
      context.stroke(path);
    });
  },
};

function connect(path: Path2D, scene: Scene, frame: Frame): void {
  const ranges_m = rangesOf(scene.setting).flatMap(({ kind, count }) =>
    Array<number>(count).fill(kind.radio_range_m ?? -1),
  );
  let drawn = 0;
  for (let a = 0; a < frame.count; a++) {
    for (let b = a + 1; b < frame.count && drawn < mostLinks; b++) {
      drawn += link(path, frame, a, b, Math.min(ranges_m[a] ?? -1, ranges_m[b] ?? -1));
    }
  }
}

function fromOne(path: Path2D, { setting, selected }: Scene, frame: Frame): void {
  const range_m = kindOf(setting, selected)?.radio_range_m ?? -1;
  let drawn = 0;
  for (let b = 0; b < frame.count && drawn < mostLinks; b++) drawn += link(path, frame, selected, b, range_m);
}

function link(path: Path2D, { robots }: Frame, a: number, b: number, range_m: number): number {
  const [ax, ay, bx, by] = [
    robots[4 * a] ?? 0,
    robots[4 * a + 1] ?? 0,
    robots[4 * b] ?? 0,
    robots[4 * b + 1] ?? 0,
  ];
  if (Math.hypot(ax - bx, ay - by) > range_m) return 0;
  path.moveTo(ax, ay);
  path.lineTo(bx, by);
  return 1;
}
