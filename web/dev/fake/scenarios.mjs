/** The scenarios of the fake server, as the real one would send them. */

const yard = {
  engine: "metric",
  merit: "equation-5.2",
  clock: { step_s: 0.1, time_limit_s: 120 },
  world: {
    size_m: [25, 25],
    obstacles: [
      {
        polygon_m: [
          [4, 5],
          [9, 5],
          [9, 6],
          [4, 6],
        ],
      },
      {
        polygon_m: [
          [16, 14],
          [17, 14],
          [17, 19],
          [20, 19],
          [20, 20],
          [16, 20],
        ],
      },
      {
        polygon_m: [
          [18, 4],
          [21, 6],
          [17, 8],
        ],
      },
      { circle: { at_m: [8, 16], radius_m: 1.5 } },
      { circle: { at_m: [13, 10], radius_m: 0.5 } },
    ],
  },
  items: { mine: { count: 4 }, scrap: { count: 2, target: false } },
};

export const entries = [
  entry(
    "search-beliefs",
    "The search of four items by one to twenty ground robots that map, share and plan.",
  ),
  entry("search", "Four items on a field of 25 m by 25 m, one to twenty ground robots, 120 seconds."),
  entry(
    "open-field",
    "Mines and clutter on a field with a ruin and a swamp, searched on the ground and from the air.",
  ),
  entry("flock", "A flock of 400 birds: they keep apart, take each other's course, and stay together."),
  { ...entry("mine/room.toml", "A room of my own."), where: "folder" },
];

function entry(id, summary) {
  return { id, name: id.replace(/^.*\/|\.toml$/g, ""), engine: "metric", summary, where: "bundled" };
}

/** The document of a scenario; `crowd-N` has N robots. */
export function documentOf(id) {
  const crowd = /^crowd-(\d+)$/.exec(id ?? "");
  if (crowd) return crowded(Number(crowd[1]));
  if (id === "open-field") return field();
  const brain = {
    rate_hz: 5,
    arbitration: { kind: "goals" },
    behaviours: [{ kind: "bayesian_search" }, { kind: "return_home" }, { kind: "avoid" }],
  };
  const rover = { model: "ugv", count: id === "flock" ? 400 : 4, drive: { max_speed_m_s: 1 }, brain };
  return structuredClone({ ...yard, summary: entryOf(id).summary, robots: { rover } });
}

export function entryOf(id) {
  return (
    entries.find((one) => one.id === id) ?? { ...entry(id ?? "my scenario", "A scenario."), id: id ?? null }
  );
}

function field() {
  return {
    ...structuredClone(yard),
    summary: entryOf("open-field").summary,
    world: {
      size_m: [60, 40],
      obstacles: [{ map: "open-field.yaml" }, ...structuredClone(yard.world.obstacles)],
    },
    terrain: {
      grass: {
        speed: 0.9,
        areas_m: [
          [
            [0, 0],
            [60, 0],
            [60, 20],
            [0, 20],
          ],
        ],
      },
      swamp: {
        speed: 0.4,
        areas_m: [
          [
            [20, 4],
            [34, 2],
            [36, 10],
            [24, 12],
          ],
        ],
      },
    },
    items: {
      mine: { count: 6 },
      flag: {
        count: 2,
        placement: {
          kind: "fixed",
          at_m: [
            [30, 18],
            [56, 36],
          ],
        },
      },
      scrap: { count: 10, target: false },
    },
    robots: { rover: { model: "ugv", count: 6 }, bird: { model: "quadrotor", count: 2 } },
  };
}

function crowded(count) {
  return {
    engine: "metric",
    summary: `A crowd of ${count} robots.`,
    merit: "equation-5.2",
    clock: { step_s: 0.1, time_limit_s: 100000 },
    world: { size_m: [1000, 560] },
    items: { mine: { count: 20 } },
    robots: { rover: { count, radius_m: 1, drive: { max_speed_m_s: 5 } } },
  };
}
