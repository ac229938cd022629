//! Neighbour lists, rebuilt when a robot may have moved half the skin distance.

use super::constants::{RADIUS_M, RANGE_M};
use base::geometry::{Disc, Point, Segment};

const SKIN_M: f64 = 0.55;
const REACH_M: f64 = RANGE_M + RADIUS_M + SKIN_M;

/// Cells over the world, and the neighbours of each robot.
pub(super) struct Lists {
    columns: usize,
    cells_per_m: f64,
    starts: Vec<u32>,
    cell_of: Vec<u32>,
    order: Vec<u32>,
    /// By cell, the pillars and walls that may be near a robot in it.
    still: Vec<[Vec<u32>; 2]>,
    pub(super) ends: Vec<[u32; 3]>,
    pub(super) things: Vec<u32>,
    /// Maximum distance that any robot can have moved since.
    pub(super) gone_m: f64,
}

impl Lists {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "small"
    )]
    pub(super) fn new(side_m: f64, pillars: &[Disc], walls: &[[Point; 2]]) -> Self {
        let columns = (side_m / (REACH_M / 2.0)).floor().max(1.0);
        let cell_m = side_m / columns;
        let reach_m = RANGE_M + SKIN_M / 2.0 + cell_m * std::f64::consts::FRAC_1_SQRT_2;
        let cells = 0..(columns * columns) as u32;
        let still = cells.map(|cell| {
            let middle = |number: f64| (number + 0.5) * cell_m;
            let row = (f64::from(cell) / columns).floor();
            let at = Point {
                x: middle(f64::from(cell) - row * columns),
                y: middle(row),
            };
            [
                near(pillars, |pillar| pillar.distance_m(at) < reach_m),
                near(walls, |wall| segment(wall).distance_m(at) < reach_m),
            ]
        });
        Self {
            still: still.collect(),
            columns: columns as usize,
            cells_per_m: columns / side_m,
            starts: Vec::new(),
            cell_of: Vec::new(),
            order: Vec::new(),
            ends: Vec::new(),
            things: Vec::new(),
            gone_m: f64::INFINITY,
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a cast saturates"
    )]
    fn cell(&self, at: f64) -> usize {
        ((at * self.cells_per_m) as usize).min(self.columns - 1)
    }

    /// Whether robots may have moved farther than the lists allow.
    pub(super) fn are_outdated(&self) -> bool {
        2.0 * self.gone_m > SKIN_M
    }

    /// Sorts robots by cell; returns their new order.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "robots have 32-bit numbers"
    )]
    pub(super) fn sort(&mut self, x: &[f64], y: &[f64]) -> &[u32] {
        let cells = x.iter().zip(y).map(|(x, y)| {
            let (column, row) = (self.cell(*x), self.cell(*y));
            (row * self.columns + column) as u32
        });
        let cells: Vec<u32> = cells.collect();
        self.cell_of = cells;
        self.starts.clear();
        self.starts.resize(self.columns * self.columns + 1, 0);
        for cell in &self.cell_of {
            self.starts[*cell as usize + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        let mut next = self.starts.clone();
        self.order.resize(x.len(), 0);
        for (robot, cell) in self.cell_of.iter().enumerate() {
            self.order[next[*cell as usize] as usize] = robot as u32;
            next[*cell as usize] += 1;
        }
        &self.order
    }

    /// Lists the neighbours of each robot; robots are sorted by cell.
    pub(super) fn rebuild(&mut self, places: [&[f64]; 2], pillars: &[Disc], walls: &[[Point; 2]]) {
        self.gone_m = 0.0;
        self.ends.clear();
        self.things.clear();
        for robot in 0..places[0].len() {
            self.list(robot, places, pillars, walls);
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "robots have 32-bit numbers"
    )]
    fn list(&mut self, robot: usize, [x, y]: [&[f64]; 2], pillars: &[Disc], walls: &[[Point; 2]]) {
        let at = Point {
            x: x[robot],
            y: y[robot],
        };
        let (left, right) = (self.cell(at.x - REACH_M), self.cell(at.x + REACH_M));
        let mut end = self.things.len();
        for row in self.cell(at.y - REACH_M)..=self.cell(at.y + REACH_M) {
            let cells = row * self.columns;
            let first = self.starts[cells + left] as usize;
            let last = self.starts[cells + right + 1] as usize;
            self.things.resize(end + (last - first), 0);
            for other in first..last {
                let (dx, dy) = (x[other] - at.x, y[other] - at.y);
                let is_near = (dx * dx + dy * dy < REACH_M * REACH_M) & (other != robot);
                self.things[end] = other as u32;
                end += usize::from(is_near);
            }
        }
        self.things.truncate(end);
        let robots = end as u32;
        let [near_pillars, near_walls] =
            &self.still[self.cell(at.y) * self.columns + self.cell(at.x)];
        let is_near =
            |pillar: &&u32| pillars[**pillar as usize].distance_m(at) < RANGE_M + SKIN_M / 2.0;
        self.things.extend(near_pillars.iter().filter(is_near));
        let pillars = self.things.len() as u32;
        let is_face = |wall: &&u32| faces(&walls[**wall as usize], at);
        self.things.extend(near_walls.iter().filter(is_face));
        self.ends.push([robots, pillars, self.things.len() as u32]);
    }
}

fn near<T>(things: &[T], is_near: impl Fn(&T) -> bool) -> Vec<u32> {
    let near = (0..).zip(things).filter(|(_, thing)| is_near(thing));
    near.map(|(number, _)| number).collect()
}

fn segment([from, to]: &[Point; 2]) -> Segment {
    Segment {
        from: *from,
        to: *to,
    }
}

/// Whether the face of a wall may be in range soon.
fn faces(wall: &[Point; 2], at: Point) -> bool {
    let wall = segment(wall);
    let height_m = at.to(wall.from).cross(wall.way()) / wall.length_m();
    height_m > -SKIN_M / 2.0 && wall.distance_m(at) < RANGE_M + SKIN_M / 2.0
}
