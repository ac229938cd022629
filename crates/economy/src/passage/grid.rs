//! The places of a lane where the centre of a vehicle can be.

use base::geometry::{Point, Rectangle};
use core::ops::Range;

/// Maximum number of places, about: the search of a path visits each once.
const MAX_CELLS: f64 = 65_536.0;

/// Places within the width of a path.
const PER_WIDTH: f64 = 6.0;

/// A gap smaller than this, in metres, is none.
const TOLERANCE_M: f64 = 1e-6;

/// A lane as a grid of cells along its longer side: columns from one of its short sides to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassageGrid {
    area: Rectangle,
    is_along_x: bool,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// The sides of a cell, along the lane and across it.
    pub(super) along_m: f64,
    pub(super) across_m: f64,
    /// The first row in which the centre of a vehicle can be; the last is as far from the other side.
    margin: usize,
}

impl PassageGrid {
    /// The grid of an area, for a path of a width.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "at most about 65,536 cells"
    )]
    pub fn new(area: Rectangle, width_m: f64) -> Self {
        let size = area.size();
        let is_along_x = size.x >= size.y;
        let (length_m, lane_m) = (size.x.max(size.y), size.x.min(size.y));
        let finest_m = libm::sqrt(length_m * lane_m / MAX_CELLS);
        let side_m = (width_m / PER_WIDTH).max(finest_m).max(f64::MIN_POSITIVE);
        let count = |along_m: f64| libm::round(along_m / side_m).clamp(1.0, MAX_CELLS) as usize;
        // An odd number of rows: a vehicle that is as wide as the lane drives in the middle one.
        let (columns, rows) = (count(length_m).max(2), count(lane_m / 2.0) * 2 + 1);
        let across_m = lane_m / rows as f64;
        let margin = (width_m / 2.0 - TOLERANCE_M) / across_m - 0.5;
        Self {
            area,
            is_along_x,
            columns,
            rows,
            along_m: length_m / columns as f64,
            across_m,
            margin: (libm::ceil(margin).max(0.0) as usize).min(rows / 2),
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// The centre of a cell, in the world. Cells are numbered by columns.
    #[must_use]
    pub fn centre(&self, cell: usize) -> Point {
        self.place(self.along_of(cell), self.across_of(cell))
    }

    /// The cells in a rectangle of the world, and some around it.
    pub fn within(&self, area: &Rectangle) -> impl Iterator<Item = usize> + use<> {
        let [low, high] = [area.min(), area.max()].map(|corner| self.coordinates(corner));
        let columns = range([low[0], high[0]], self.along_m, self.columns);
        let rows = range([low[1], high[1]], self.across_m, self.rows);
        let height = self.rows;
        columns.flat_map(move |column| rows.clone().map(move |row| column * height + row))
    }

    /// Whether a path of its width at a cell is within the sides of the lane.
    #[must_use]
    pub fn is_inside(&self, cell: usize) -> bool {
        let row = cell % self.rows;
        (self.margin..self.rows - self.margin).contains(&row)
    }

    /// The place on a short side that is nearest to a cell: the first one or the last.
    pub(super) fn end(&self, cell: usize, is_last: bool) -> Point {
        let along_m = if is_last { self.length_m() } else { 0.0 };
        self.place(along_m, self.across_of(cell))
    }

    /// The length of the lane.
    #[expect(clippy::cast_precision_loss, reason = "at most about 65,536 cells")]
    pub(super) fn length_m(&self) -> f64 {
        self.along_m * self.columns as f64
    }

    /// How far a cell is from the middle line of the lane, as a share of half its width.
    #[expect(clippy::cast_precision_loss, reason = "at most about 65,536 cells")]
    pub(super) fn off_middle(&self, cell: usize) -> f64 {
        let row = (cell % self.rows) as f64;
        (2.0 * row + 1.0 - self.rows as f64).abs() / self.rows as f64
    }

    /// The coordinates of a place in the world along the lane and across it, from its lower left corner.
    pub(super) fn coordinates(&self, at: Point) -> [f64; 2] {
        let from = self.area.min().to(at);
        if self.is_along_x {
            [from.x, from.y]
        } else {
            [from.y, from.x]
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "at most about 65,536 cells")]
    fn along_of(&self, cell: usize) -> f64 {
        ((cell / self.rows) as f64 + 0.5) * self.along_m
    }

    #[expect(clippy::cast_precision_loss, reason = "at most about 65,536 cells")]
    fn across_of(&self, cell: usize) -> f64 {
        ((cell % self.rows) as f64 + 0.5) * self.across_m
    }

    fn place(&self, along_m: f64, across_m: f64) -> Point {
        let [x, y] = if self.is_along_x {
            [along_m, across_m]
        } else {
            [across_m, along_m]
        };
        self.area.min().plus(Point { x, y })
    }
}

/// The numbers of the cells between two coordinates.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped"
)]
pub(super) fn range([from_m, to_m]: [f64; 2], side_m: f64, count: usize) -> Range<usize> {
    let first = libm::floor(from_m / side_m).max(0.0) as usize;
    let end = libm::ceil(to_m / side_m).max(0.0) as usize;
    first.min(count)..end.min(count)
}
