//! Discs of one size, found by where they are.

use crate::geometry::Point;
use std::collections::HashMap;

/// Discs that come nearer to each other than this, in metres, overlap; less is rounding.
const TOLERANCE_M: f64 = 1e-9;

/// Least side of a cell, in metres, so that the numbers of cells stay exact.
const MIN_SIDE_M: f64 = 1e-3;

/// Discs of one radius, in square cells of their diameter: if they do not overlap, a cell holds a
/// few. Memory goes with the number of discs, never with the world's size.
#[derive(Debug, Clone)]
pub(super) struct Crowd {
    radius_m: f64,
    side_m: f64,
    centres: Vec<Point>,
    /// The last disc that was put into a cell.
    last: HashMap<(i64, i64), usize>,
    /// For each disc the one that was put into its cell before.
    before: Vec<Option<usize>>,
}

impl Crowd {
    pub(super) fn new(radius_m: f64) -> Self {
        Self {
            radius_m,
            side_m: (2.0 * radius_m).max(MIN_SIDE_M),
            centres: Vec::new(),
            last: HashMap::new(),
            before: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, centre: Point) {
        let cell = (self.cell(centre.x), self.cell(centre.y));
        self.before.push(self.last.insert(cell, self.centres.len()));
        self.centres.push(centre);
    }

    /// Whether a disc about `centre` overlaps one of these; discs that only touch do not.
    pub(super) fn overlaps(&self, centre: Point, radius_m: f64) -> bool {
        let reach_m = self.radius_m + radius_m - TOLERANCE_M;
        let is_near =
            |other: Point| reach_m > 0.0 && centre.to(other).length_squared() < reach_m * reach_m;
        let columns = self.cell(centre.x - reach_m)..=self.cell(centre.x + reach_m);
        let rows = self.cell(centre.y - reach_m)..=self.cell(centre.y + reach_m);
        // A large disc among a few small ones: these are fewer than the cells that it covers.
        let side = 2.0 * reach_m / self.side_m + 1.0;
        if side * side > 9.0 + length(&self.centres) {
            return self.centres.iter().any(|&other| is_near(other));
        }
        columns
            .flat_map(|column| rows.clone().map(move |row| (column, row)))
            .any(|cell| self.within(cell).any(is_near))
    }

    fn within(&self, cell: (i64, i64)) -> impl Iterator<Item = Point> + '_ {
        let last = self.last.get(&cell).copied();
        std::iter::successors(last, |&disc| self.before[disc]).map(|disc| self.centres[disc])
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "places are within 1e9 metres and a cell's side is at least 1e-3"
    )]
    fn cell(&self, coordinate: f64) -> i64 {
        (coordinate / self.side_m).floor() as i64
    }
}

#[expect(clippy::cast_precision_loss, reason = "at most 2^28 robots")]
fn length(centres: &[Point]) -> f64 {
    centres.len() as f64
}
