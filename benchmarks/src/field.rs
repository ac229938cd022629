//! The sensing team: robots with a ring of sixteen sonars among pillars and boxes.

use base::geometry::{Disc, Point, Polygon};
use sim::scenario::{Scenario, ScenarioSpec};
use sim::world::obstacles::Solid;

/// Side of a square in metres, and its numbers of robots, pillars and boxes.
const SIDE_M: f64 = 20.0;
const ROBOTS: u32 = 100;
const PILLARS: u32 = 20;
const BOXES: u32 = 10;

/// A field of several squares, with a wall around it.
pub(crate) struct Field {
    pub(crate) robots: u32,
    pub(crate) side_m: f64,
    pub(crate) pillars: Vec<Disc>,
    /// Their minimum and maximum corners.
    pub(crate) boxes: Vec<[Point; 2]>,
}

impl Field {
    /// The field for a number of robots: a hundred times a square number.
    pub(crate) fn new(robots: u32) -> Self {
        let tiles = f64::from(robots / ROBOTS).sqrt().round().max(1.0);
        let mut chance = Chance(1);
        let (mut pillars, mut boxes) = (Vec::new(), Vec::new());
        let mut row = 0.0;
        while row < tiles {
            let mut column = 0.0;
            while column < tiles {
                let mut place = || Point {
                    x: (column + chance.unit()) * SIDE_M,
                    y: (row + chance.unit()) * SIDE_M,
                };
                let pillar_places: Vec<Point> = (0..PILLARS).map(|_| place()).collect();
                let box_places: Vec<Point> = (0..BOXES).map(|_| place()).collect();
                pillars.extend(pillar_places.into_iter().map(|centre| Disc {
                    centre,
                    radius_m: 0.2 + 0.3 * chance.unit(),
                }));
                boxes.extend(box_places.into_iter().map(|at| {
                    let half = 0.2 + 0.3 * chance.unit();
                    let corner = Point { x: half, y: half };
                    [corner.to(at), at.plus(corner)]
                }));
                column += 1.0;
            }
            row += 1.0;
        }
        Self {
            robots,
            side_m: SIDE_M * tiles,
            pillars,
            boxes,
        }
    }

    /// The scenario with everything enabled: range noise, battery, collisions, judge.
    pub(crate) fn scenario(&self) -> Scenario {
        let rover = serde_json::json!({
            "count": self.robots,
            "radius_m": 0.2,
            "drive": {
                "max_speed_m_s": 0.5,
                "max_acceleration_m_s2": 1.0,
                "max_turn_rate_deg_s": 90.0,
            },
            "battery": {"idle_w": 10.0, "move_w": 5.0, "move_j_per_m": 10.0},
            "sensors": {"sonar": {"kind": "range", "rays": 16, "range_m": 3.0, "noise_m": 0.02}},
        });
        let spec = serde_json::json!({
            "clock": {"time_limit_s": 1e6},
            "world": {"size_m": [self.side_m, self.side_m]},
            "robots": {"rover": rover},
        });
        let spec: ScenarioSpec = serde_json::from_value(spec).expect("it is as it should be");
        let pillars = self.pillars.iter().copied().map(Solid::Disc);
        let boxes = self.boxes.iter().map(|ends| corners(*ends));
        let boxes = boxes.filter_map(|corners| Polygon::new(&corners).ok());
        let solids = pillars.chain(boxes.map(Solid::Polygon)).collect();
        Scenario::new(&spec, solids, Vec::new())
    }

    /// All walls, with free space on their left.
    pub(crate) fn walls(&self) -> Vec<[Point; 2]> {
        let room = [
            Point::default(),
            Point {
                x: self.side_m,
                y: self.side_m,
            },
        ];
        let mut outline = corners(room);
        outline.reverse();
        let outlines = self.boxes.iter().map(|ends| corners(*ends));
        let outlines = outlines.chain([outline]);
        let walls = outlines.flat_map(|[a, b, c, d]| [[a, b], [b, c], [c, d], [d, a]]);
        walls.collect()
    }
}

/// Clockwise.
fn corners([low, high]: [Point; 2]) -> [Point; 4] {
    let at = |x, y| Point { x, y };
    [low, at(low.x, high.y), high, at(high.x, low.y)]
}

/// Knuth's linear congruential generator, which is good enough for these fields.
struct Chance(u64);

impl Chance {
    fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let word = (self.0 >> 32) as u32;
        f64::from(word) / 4_294_967_296.0
    }
}
