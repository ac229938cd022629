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

/// A wall closes the centres within the radius less half a diagonal of a cell. That is a band without gaps if its
/// width is at least a diagonal: with a radius of the square root of 2, and some more for rounding.
const CELLS_OF_WALL: f64 = 1.5;

/// The places that a robot may reach, and the parts of the world between which it finds no way.
#[derive(Debug, Clone)]
pub struct Reachability {
    cells: Cells,
    open: Runs,
    /// By part, whether the robot may start there.
    is_reached: Vec<bool>,
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
        let open = Runs::open(&is_closed, cells.columns());
        let mut is_reached = vec![false; open.count()];
        for run in starts.iter().flat_map(|start| cells.touched_by(start)) {
            for part in open.parts_in(&run) {
                is_reached[part as usize] = true;
            }
        }
        Self {
            cells,
            open,
            is_reached,
        }
    }

    /// The smallest radius with which no fill passes any wall in a world.
    #[must_use]
    pub fn min_radius_m(world: Rectangle) -> f64 {
        CELLS_OF_WALL * Cells::new(world, 0.0).side_m()
    }

    /// Number of parts of the world that the robot fits into, between which it finds no way.
    #[must_use]
    pub fn parts(&self) -> usize {
        self.is_reached.len()
    }

    /// Whether the robot's centre may come within `distance_m` of `point`; false is certain. Takes time
    /// linear in the number of rows within that distance.
    #[must_use]
    pub fn may_come_near(&self, point: Point, distance_m: f64) -> bool {
        self.parts_near(point, distance_m)
            .any(|part| self.is_reached(part))
    }

    /// The parts in which the robot's centre may be within `distance_m` of `point`, each once or more.
    pub fn parts_near(&self, point: Point, distance_m: f64) -> impl Iterator<Item = u32> {
        let far_m = distance_m + self.cells.half_diagonal_m() + TOLERANCE_M;
        let reach = Solid::Pillar(Disc {
            centre: point,
            radius_m: 0.0,
        });
        let near = self.cells.near(reach, far_m);
        near.flat_map(|run| self.open.parts_in(&run))
    }

    /// Whether the robot may start in a part; false is certain.
    #[must_use]
    pub fn is_reached(&self, part: u32) -> bool {
        self.is_reached.get(part as usize).copied().unwrap_or(false)
    }

    /// The middle of a cell of a part, if there is such a part.
    #[must_use]
    pub fn place_in(&self, part: u32) -> Option<Point> {
        self.open.first_of(part).map(|run| self.cells.middle(run))
    }
}

#[cfg(test)]
mod tests;
