//! The shortest way around what is known to be filled.
//!
//! A wave runs from the aim over all cells that the body fits into (Dijkstra, *A note on two problems
//! in connexion with graphs*, 1959, with whole numbers: 5 a step, 7 a step aslant); the robot goes down
//! it as far as it sees a straight way. What is unknown counts as free.
//!
//! What the body does not fit into is as far as it is to stand before it: a wave runs into it but not
//! out again on the other side, and out of it where it begins there.

use crate::beliefs::field::Field;
use crate::beliefs::occupancy::Occupancy;
use alloc::vec::Vec;
use base::geometry::Point;

/// A step along a row or a column, and one aslant; 7 / 5 is near the square root of 2.
const STRAIGHT: u16 = 5;
const ASLANT: u16 = 7;

/// There is no way.
const NEVER: u16 = u16::MAX;

/// Waves end here: no way on a field of some thousand cells is longer, but for mazes.
const FARTHEST: u16 = NEVER - ASLANT;

/// Steps to neighbours: columns, rows, cost.
const STEPS: [(i32, i32, u16); 8] = [
    (1, 0, STRAIGHT),
    (0, 1, STRAIGHT),
    (-1, 0, STRAIGHT),
    (0, -1, STRAIGHT),
    (1, 1, ASLANT),
    (-1, 1, ASLANT),
    (-1, -1, ASLANT),
    (1, -1, ASLANT),
];

/// What a cell is to a body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
enum Ground {
    #[default]
    Open,
    /// Too near to something filled, and so far not come to from what is open.
    Tight,
    /// The same, come to from what is open.
    Shore,
    Filled,
}

/// How far every cell is from one place. Two bytes a cell and two for the wave.
#[derive(Debug, Clone, Default)]
pub(crate) struct Wave {
    fifths: Vec<u16>,
    grounds: Vec<Ground>,
    /// Cells to go on from, by what is left of their cost modulo 8.
    fronts: [Vec<u16>; 8],
}

impl Wave {
    /// Lets a wave run from `from`; a body of this radius must fit.
    pub(crate) fn run(&mut self, field: &Field, map: &Occupancy, from: Point, radius_m: f64) {
        self.close(field, map, radius_m);
        self.fifths.clear();
        self.fifths.resize(field.cells(), NEVER);
        self.fronts.iter_mut().for_each(Vec::clear);
        self.reach(field.nearest_cell(from), 0);
        let mut cost = 0;
        let mut empty = 0;
        while empty < 8 && cost < FARTHEST {
            let front = core::mem::take(&mut self.fronts[usize::from(cost % 8)]);
            empty = if front.is_empty() { empty + 1 } else { 0 };
            for cell in &front {
                if self.fifths[usize::from(*cell)] == cost {
                    self.go_on(field, usize::from(*cell), cost);
                }
            }
            // Its room is used again.
            let mut room = front;
            room.clear();
            self.fronts[usize::from(cost % 8)] = room;
            cost += 1;
        }
    }

    /// Closes the cells that a body does not fit into.
    fn close(&mut self, field: &Field, map: &Occupancy, radius_m: f64) {
        self.grounds.clear();
        self.grounds.resize(field.cells(), Ground::Open);
        for filled in (0..field.cells()).filter(|cell| map.is_filled(*cell)) {
            let centre = field.centre(filled);
            for cell in field.about(centre, radius_m) {
                let is_near = field.centre(cell).to(centre).length() <= radius_m;
                if is_near && self.grounds[cell] == Ground::Open {
                    self.grounds[cell] = Ground::Tight;
                }
            }
            self.grounds[filled] = Ground::Filled;
        }
    }

    fn go_on(&mut self, field: &Field, cell: usize, cost: u16) {
        let ground = self.grounds[cell];
        let [column, row] = field.column_and_row_of(cell);
        for (right, up, step) in STEPS {
            let next = field.number(column + right, row + up);
            let Some(next) = next.filter(|next| self.fifths[*next] > cost + step) else {
                continue;
            };
            if cost > 0 && !self.goes_on(cell, next) {
                continue;
            }
            let is_from_open = ground != Ground::Tight && cost > 0;
            if is_from_open && self.grounds[next] == Ground::Tight {
                self.grounds[next] = Ground::Shore;
            }
            self.reach(next, cost + step);
        }
    }

    /// Whether a wave goes from one cell on to the next.
    #[inline]
    fn goes_on(&self, from: usize, to: usize) -> bool {
        match self.grounds[from] {
            Ground::Open | Ground::Tight => true,
            Ground::Shore => self.grounds[to] != Ground::Open,
            Ground::Filled => false,
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "at most some thousand cells"
    )]
    fn reach(&mut self, cell: usize, cost: u16) {
        self.fifths[cell] = cost;
        self.fronts[usize::from(cost % 8)].push(cell as u16);
    }

    /// Whether none has run yet.
    pub(crate) fn is_new(&self) -> bool {
        self.fifths.is_empty()
    }

    /// How far a cell is by the way; `None` if there is none.
    #[inline]
    pub(crate) fn cell_distance_m(&self, field: &Field, cell: usize) -> Option<f64> {
        let fifths = self
            .fifths
            .get(cell)
            .copied()
            .filter(|fifths| *fifths < NEVER)?;
        Some(f64::from(fifths) / f64::from(STRAIGHT) * field.cell_m)
    }

    /// The next cell on the way from one to where the wave began; `None` there, or if there is no way.
    fn next(&self, field: &Field, cell: usize) -> Option<usize> {
        let [column, row] = field.column_and_row_of(cell);
        let next = STEPS.iter().filter_map(|(right, up, step)| {
            let next = field.number(column + right, row + up)?;
            let fifths = self.fifths[next];
            let is_open = fifths < NEVER && (fifths == 0 || self.goes_on(next, cell));
            is_open.then(|| (fifths.saturating_add(*step), fifths, next))
        });
        // What is closed itself, as where a robot grazes a wall, leads out by any way.
        let (_, fifths, next) = next.min()?;
        (fifths < self.fifths[cell]).then_some(next)
    }

    /// Whether a body does not fit into a cell.
    #[inline]
    pub(crate) fn is_shut(&self, cell: usize) -> bool {
        self.grounds[cell] != Ground::Open
    }

    /// The farthest place on the way from `from` that lies straight ahead.
    pub(crate) fn ahead(&self, field: &Field, from: Point) -> Option<Point> {
        let mut cell = field.nearest_cell(from);
        let mut seen = None;
        for _ in 0..field.cells() {
            let Some(next) = self.next(field, cell) else {
                break;
            };
            let place = field.centre(next);
            if seen.is_some() && !self.is_open_between(field, from, place) {
                break;
            }
            (seen, cell) = (Some(place), next);
        }
        seen
    }

    /// Whether the body fits through on the straight way between two places.
    pub(crate) fn is_open_between(&self, field: &Field, from: Point, to: Point) -> bool {
        let way = from.to(to);
        let length_m = way.length();
        let stride_m = field.cell_m / 2.0;
        let mut along_m = stride_m;
        while along_m < length_m {
            let place = from.plus(way.times(along_m / length_m));
            if field.cell(place).is_some_and(|cell| self.is_shut(cell)) {
                return false;
            }
            along_m += stride_m;
        }
        true
    }
}
