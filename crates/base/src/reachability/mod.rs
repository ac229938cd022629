//! The parts of a world that a robot can never reach, to report unreachable items before any run.
//!
//! The answer is conservative: [`Reachability::may_come_near`] returns false only if it is certain. The
//! world is divided into square cells. A cell is closed if every point of it is closer to something
//! solid than the robot's radius, that is, if its centre is closer by half the cell's diagonal. A
//! moving robot passes from each cell to a neighbour, by a side or by a corner; so a flood fill from
//! the start cells, through cells that are not closed, finds all cells that it may reach.
//!
//! The fill also passes gaps that are narrower than the robot by less than the diagonal of a cell.
//! Cells are a quarter of the radius wide, so that every gap below four fifths of the robot's width is
//! detected as too narrow. In a world that [`MAX_CELLS`] such cells do not cover, cells are wider; once
//! their diagonal is the robot's width, no wall closes any cell.

mod cells;

pub use cells::{MAX_CELLS, Solid};

use crate::geometry::{Disc, Point, Rectangle};
use cells::{Cells, TOLERANCE_M};

/// The places that a robot may reach.
#[derive(Debug, Clone)]
pub struct Reachability {
    cells: Cells,
    /// Cumulative number of reachable cells, row by row.
    flooded_before: Vec<u32>,
}

impl Reachability {
    /// The places that a robot of `radius_m` may reach from anywhere in its `starts` (an empty rectangle
    /// for a single point), within the walls of `world` and around the `solid` obstacles.
    ///
    /// Takes a few bytes per cell, of at most [`MAX_CELLS`], and time linear in cells and obstacles.
    #[must_use]
    pub fn new(
        world: Rectangle,
        radius_m: f64,
        solid: impl IntoIterator<Item = Solid>,
        starts: &[Rectangle],
    ) -> Self {
        let cells = Cells::new(world, radius_m);
        let mut is_closed = vec![false; cells.count()];
        // Every point of a cell is within the radius of an obstacle if the centre is this close to it.
        let sure_m = radius_m - cells.half_diagonal_m() - TOLERANCE_M;
        let walls = world.room().map(Solid::Wall);
        for solid in solid.into_iter().chain(walls) {
            for near in cells.near(solid, sure_m) {
                is_closed[near].fill(true);
            }
        }
        let is_flooded = flood(&cells, is_closed, starts);
        let counts = is_flooded.iter().scan(0, |count, is_flooded| {
            *count += u32::from(*is_flooded);
            Some(*count)
        });
        Self {
            cells,
            flooded_before: std::iter::once(0).chain(counts).collect(),
        }
    }

    /// Whether the robot's centre may come within `distance_m` of `point`; false is certain. Takes time
    /// linear in the number of rows within that distance.
    #[must_use]
    pub fn may_come_near(&self, point: Point, distance_m: f64) -> bool {
        let far_m = distance_m + self.cells.half_diagonal_m() + TOLERANCE_M;
        let reach = Solid::Pillar(Disc {
            centre: point,
            radius_m: 0.0,
        });
        let mut near = self.cells.near(reach, far_m);
        near.any(|cells| {
            self.flooded_before[*cells.start()] < self.flooded_before[*cells.end() + 1]
        })
    }
}

/// The cells that are connected to those of `starts` through cells that are not closed.
fn flood(cells: &Cells, mut is_closed: Vec<bool>, starts: &[Rectangle]) -> Vec<bool> {
    let mut is_flooded = vec![false; cells.count()];
    let mut ahead: Vec<(u32, u32)> = Vec::new();
    let mut visit = |cell: (u32, u32), ahead: &mut Vec<(u32, u32)>| {
        let index = cells.index(cell);
        // Close reached cells, so that each is visited once.
        if !std::mem::replace(&mut is_closed[index], true) {
            is_flooded[index] = true;
            ahead.push(cell);
        }
    };
    for start in starts {
        for cell in cells.touched_by(start) {
            visit(cell, &mut ahead);
        }
    }
    while let Some(cell) = ahead.pop() {
        for neighbour in cells.neighbours(cell) {
            visit(neighbour, &mut ahead);
        }
    }
    is_flooded
}

#[cfg(test)]
mod tests;
