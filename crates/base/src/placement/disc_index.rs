//! A spatial hash of the discs of placed robots.

use crate::geometry::{Point, Torus};
use std::collections::HashMap;

/// Discs overlap if they are closer than this, in metres; less is rounding.
const TOLERANCE_M: f64 = 1e-9;

/// Side of a cell in radii: the surroundings of a robot span few cells, and a cell holds few robots.
const SIDE: f64 = 8.0;

/// Minimum side of a cell, in metres, so that cell indices stay exact.
const MIN_SIDE_M: f64 = 1e-3;

/// The positions of the robots of each kind. Memory is proportional to their number, independent of the
/// size of the world.
#[derive(Debug, Clone)]
pub struct DiscIndex {
    kinds: Vec<Discs>,
    torus: Option<Torus>,
}

impl DiscIndex {
    /// An empty index of `kinds`, each given by its layer and its radius, and identified by its place in
    /// the list. On a torus, all positions are within its rectangle.
    #[must_use]
    pub fn new(kinds: impl IntoIterator<Item = (u8, f64)>, torus: Option<Torus>) -> Self {
        let discs = |(layer, radius_m)| Discs::new(layer, radius_m);
        Self {
            kinds: kinds.into_iter().map(discs).collect(),
            torus,
        }
    }

    /// Adds a robot.
    pub fn add(&mut self, kind: usize, centre: Point) {
        self.kinds[kind].add(centre);
    }

    /// Removes a robot.
    pub fn remove(&mut self, kind: usize, centre: Point) {
        self.kinds[kind].remove(centre);
    }

    /// Whether a robot of a kind would overlap another one of its layer here. Touching is no overlap.
    #[must_use]
    pub fn is_taken(&self, kind: usize, centre: Point) -> bool {
        let Discs {
            layer, radius_m, ..
        } = self.kinds[kind];
        let mut others = self.kinds.iter().filter(|other| other.layer == layer);
        others.any(|other| {
            let reach_m = other.reach_m(radius_m);
            let images = self.torus.map(|torus| torus.images_within(centre, reach_m));
            let mut images = images.into_iter().flatten().chain([centre]);
            reach_m > 0.0 && images.any(|centre| other.overlap(centre, reach_m))
        })
    }
}

/// Discs of one radius, in square cells.
#[derive(Debug, Clone)]
struct Discs {
    layer: u8,
    radius_m: f64,
    side_m: f64,
    count: usize,
    cells: HashMap<(i64, i64), Vec<Point>>,
}

impl Discs {
    fn new(layer: u8, radius_m: f64) -> Self {
        Self {
            layer,
            radius_m,
            side_m: (SIDE * radius_m).max(MIN_SIDE_M),
            count: 0,
            cells: HashMap::new(),
        }
    }

    fn add(&mut self, centre: Point) {
        let cell = (self.cell(centre.x), self.cell(centre.y));
        self.cells.entry(cell).or_default().push(centre);
        self.count += 1;
    }

    fn remove(&mut self, centre: Point) {
        let cell = (self.cell(centre.x), self.cell(centre.y));
        let within = self.cells.get_mut(&cell);
        let at = within
            .as_deref()
            .and_then(|within| within.iter().position(|&other| other == centre));
        debug_assert!(at.is_some(), "there is no robot at {centre:?}");
        if let Some((within, at)) = within.zip(at) {
            within.swap_remove(at);
            self.count -= 1;
        }
    }

    /// Discs whose centres are closer than this overlap; two points never do.
    fn reach_m(&self, radius_m: f64) -> f64 {
        self.radius_m + radius_m - TOLERANCE_M
    }

    /// Whether any of them is closer than `reach_m`.
    fn overlap(&self, centre: Point, reach_m: f64) -> bool {
        let is_near = |other: &Point| centre.to(*other).length_squared() < reach_m * reach_m;
        // A large disc covers more cells than there are discs: check all of these instead.
        let side = 2.0 * reach_m / self.side_m + 1.0;
        if side * side > 9.0 + length(self.count) {
            return self.cells.values().flatten().any(is_near);
        }
        let columns = self.cell(centre.x - reach_m)..=self.cell(centre.x + reach_m);
        let rows = self.cell(centre.y - reach_m)..=self.cell(centre.y + reach_m);
        columns
            .flat_map(|column| rows.clone().map(move |row| (column, row)))
            .filter_map(|cell| self.cells.get(&cell))
            .any(|within| within.iter().any(is_near))
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
fn length(count: usize) -> f64 {
    count as f64
}

#[cfg(test)]
mod tests;
