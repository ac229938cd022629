/** Overlays of a fake run. Robots 0 and 1, 2 and 3 and so on have two-way links; the last receives from the first. */
const maxRobots = 300;

/** An overlay of the requested layers, encoded as by the real server; null if none is requested. */
export function overlayOf(run, number, { links, footprints }, selected) {
  if (!links && !footprints) return null;
  const shown = (robot) => run.count <= maxRobots || robot === selected;
  const pairs = links ? linksOf(run).filter(([from, to]) => shown(from) || shown(to)) : [];
  const robots = Array.from({ length: run.count }, (_, robot) => robot).filter(shown);
  const seen = footprints ? robots.flatMap((robot) => footprintsOf(run, robot, robot === selected)) : [];
  const numbers = [2, number, pairs.length, ...pairs.flat()];
  return Buffer.concat([u32(numbers), ...seen]);
}

function linksOf({ count }) {
  const pairs = [];
  for (let robot = 0; robot + 1 < count; robot += 2) pairs.push([robot, robot + 1, 1]);
  if (count > 2) pairs.push([0, count - 1, 0]);
  return pairs;
}

/** The left half of each camera's sector is occluded from half its range on. */
function footprintsOf(run, robot, isSelected) {
  const sensors = run.kindOf(robot).sensors.filter(({ kind }) => kind === "items" || isSelected);
  return sensors.map(({ kind, range_m, width_rad, facing_rad }) => {
    const [right, left] = [facing_rad - width_rad / 2, facing_rad + width_rad / 2];
    const near = [facing_rad, range_m / 2, left, range_m / 2];
    const corners =
      kind === "items" ? [right, range_m, facing_rad, range_m, ...near] : [right, range_m, left, range_m];
    const head = u32([robot, kind === "items" ? 1 : 0, corners.length / 2]);
    return Buffer.concat([head, f32([range_m, ...corners])]);
  });
}

function u32(numbers) {
  return Buffer.from(Uint32Array.from(numbers).buffer);
}

function f32(numbers) {
  return Buffer.from(Float32Array.from(numbers).buffer);
}
