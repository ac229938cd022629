//! A grid of square cells over the world.

use crate::geometry::{Disc, Point, Rectangle, Segment};
use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::RangeInclusive;

/// Maximum number of cells: larger worlds get larger cells.
pub const MAX_CELLS: u32 = 4_000_000;

/// Tolerance for rounding, in metres.
pub(super) const TOLERANCE_M: f64 = 1e-9;

/// An obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Solid {
    /// A wall.
    Wall(Segment),
    /// A pillar.
    Pillar(Disc),
}

/// Number of cells along the radius of the robot.
const CELLS_PER_RADIUS: f64 = 4.0;

/// Adjacent cells of a row.
#[derive(Debug, Clone)]
pub(super) struct Run {
    pub(super) row: u32,
    pub(super) columns: RangeInclusive<u32>,
}

/// Square cells that cover the world.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    corner: Point,
    side_m: f64,
    columns: u32,
    rows: u32,
}

impl Cells {
    pub(super) fn new(world: Rectangle, radius_m: f64) -> Self {
        let size = world.size();
        let most = f64::from(MAX_CELLS);
        let coarse_m = (size.x.max(size.y) / most).max((world.area_m2() / most).sqrt());
        let mut side_m = (radius_m / CELLS_PER_RADIUS).max(coarse_m);
        // Rounding columns and rows up may exceed the maximum by a few cells.
        while count(size.x, side_m) * count(size.y, side_m) > most {
            side_m *= 1.01;
        }
        Self {
            corner: world.min(),
            side_m,
            columns: whole(count(size.x, side_m)),
            rows: whole(count(size.y, side_m)),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// The number of cells in a row.
    pub(super) fn columns(&self) -> usize {
        self.columns as usize
    }

    /// The indices of a run of cells, counted row by row.
    pub(super) fn indices(&self, run: &Run) -> RangeInclusive<usize> {
        let first = run.row as usize * self.columns();
        first + *run.columns.start() as usize..=first + *run.columns.end() as usize
    }

    pub(super) fn side_m(&self) -> f64 {
        self.side_m
    }

    /// The middle of the first cell of a run.
    pub(super) fn middle(&self, run: &Run) -> Point {
        let along = |cell: u32| self.side_m * (f64::from(cell) + 0.5);
        self.corner.plus(Point {
            x: along(*run.columns.start()),
            y: along(run.row),
        })
    }

    pub(super) fn half_diagonal_m(&self) -> f64 {
        self.side_m * FRAC_1_SQRT_2
    }

    /// The cells whose centre is closer to the obstacle than `near_m`: at most one run per row.
    pub(super) fn near(&self, solid: Solid, near_m: f64) -> impl Iterator<Item = Run> {
        let cells = *self;
        let (low, high) = heights(solid, near_m);
        let rows = cells.middles(low - cells.corner.y, high - cells.corner.y, cells.rows);
        rows.into_iter().flatten().filter_map(move |row| {
            let y = cells.corner.y + cells.side_m * (f64::from(row) + 0.5);
            let (left, right) = widths(solid, near_m, y)?;
            let columns =
                cells.middles(left - cells.corner.x, right - cells.corner.x, cells.columns)?;
            Some(Run { row, columns })
        })
    }

    /// The cells that overlap the rectangle.
    pub(super) fn touched_by(&self, rectangle: &Rectangle) -> impl Iterator<Item = Run> {
        let (min, max) = (
            self.corner.to(rectangle.min()),
            self.corner.to(rectangle.max()),
        );
        // Centres may be half a side outside.
        let far_m = self.side_m / 2.0 + TOLERANCE_M;
        let rows = self.middles(min.y - far_m, max.y + far_m, self.rows);
        let columns = self.middles(min.x - far_m, max.x + far_m, self.columns);
        rows.zip(columns).into_iter().flat_map(|(rows, columns)| {
            rows.map(move |row| Run {
                row,
                columns: columns.clone(),
            })
        })
    }

    /// Of `count` cells in a line, those whose centre is from `low` to `high` along the line.
    fn middles(&self, low: f64, high: f64, count: u32) -> Option<RangeInclusive<u32>> {
        let first = (low / self.side_m - 0.5).ceil().max(0.0);
        let last = (high / self.side_m - 0.5).floor().min(f64::from(count - 1));
        (first <= last).then(|| whole(first)..=whole(last))
    }
}

/// The interval of y in which points may be closer to the obstacle than `near_m`.
fn heights(solid: Solid, near_m: f64) -> (f64, f64) {
    let (one, other, far_m) = match solid {
        Solid::Wall(wall) => (wall.from.y, wall.to.y, near_m),
        Solid::Pillar(disc) => (disc.centre.y, disc.centre.y, near_m + disc.radius_m),
    };
    (one.min(other) - far_m, one.max(other) + far_m)
}

/// The interval of x in which points at height `y` are closer to the obstacle than `near_m`.
fn widths(solid: Solid, near_m: f64, y: f64) -> Option<(f64, f64)> {
    match solid {
        Solid::Pillar(disc) => chord(disc.centre, disc.radius_m + near_m, y),
        Solid::Wall(wall) => {
            let ends = [wall.from, wall.to].map(|end| chord(end, near_m, y));
            let [from, to] = ends;
            [from, to, strip(wall, near_m, y)]
                .into_iter()
                .flatten()
                .reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)))
        }
    }
}

/// The interval of the line at height `y` within a circle.
fn chord(centre: Point, radius_m: f64, y: f64) -> Option<(f64, f64)> {
    let up = y - centre.y;
    let half = (radius_m * radius_m - up * up).sqrt();
    (radius_m > 0.0 && half >= 0.0).then_some((centre.x - half, centre.x + half))
}

/// The interval of the line at height `y` beside the wall, not beyond its ends, within `near_m`.
fn strip(wall: Segment, near_m: f64, y: f64) -> Option<(f64, f64)> {
    let way = wall.way();
    let aside = Point {
        x: -way.y,
        y: way.x,
    }
    .times(near_m / way.length());
    let back = aside.times(-1.0);
    let corners = [
        wall.from.plus(aside),
        wall.from.plus(back),
        wall.to.plus(back),
        wall.to.plus(aside),
    ];
    (0..4)
        .filter_map(|at| crossing(corners[at], corners[(at + 1) % 4], y))
        .fold(None, |all: Option<(f64, f64)>, x| {
            let (least, most) = all.unwrap_or((x, x));
            Some((least.min(x), most.max(x)))
        })
        .filter(|_| near_m > 0.0)
}

/// The intersection of the line at height `y` with the segment between two points.
fn crossing(from: Point, to: Point, y: f64) -> Option<f64> {
    let share = (y - from.y) / (to.y - from.y);
    (0.0..=1.0)
        .contains(&share)
        .then_some(from.x + share * (to.x - from.x))
}

/// Number of cells that cover a length.
fn count(length_m: f64, side_m: f64) -> f64 {
    (length_m / side_m).ceil().max(1.0)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number up to that of the cells"
)]
fn whole(value: f64) -> u32 {
    value as u32
}
