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
mod runs;

pub use cells::{MAX_CELLS, Solid};

use crate::geometry::{Disc, Point, Rectangle};
use cells::{Cells, TOLERANCE_M};
use runs::Runs;

/// The places that a robot may reach.
#[derive(Debug, Clone)]
pub struct Reachability {
    cells: Cells,
    reached: Runs,
}

impl Reachability {
    /// The places that a robot of `radius_m` may reach from anywhere in its `starts` (an empty rectangle
    /// for a single point), within the walls of `world` and around the `solid` obstacles.
    ///
    /// Takes a byte per cell, of at most [`MAX_CELLS`], and time linear in cells and obstacles.
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
                is_closed[cells.indices(&near)].fill(true);
            }
        }
        let starts = starts.iter().flat_map(|start| cells.touched_by(start));
        let open = Runs::open(&is_closed, cells.columns());
        Self {
            cells,
            reached: open.connected_to(starts),
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
        near.any(|run| self.reached.overlap(&run))
    }
}

#[cfg(test)]
mod tests;
