/** What lies over a frame of a fake run: every other robot and the next hear each other, the last hears the first. */
const mostRobots = 300;

/** Bytes as the real server sends them, of the layers that a page has asked for; null if it has for none. */
export function overlayOf(run, number, { links, footprints }, selected) {
  if (!links && !footprints) return null;
  const shown = (robot) => run.count <= mostRobots || robot === selected;
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

/** Something hides the left half of what cameras see, from half way on. */
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
