//! Which places a robot can never come to, to tell a user before any run.
//!
//! The answer errs on one side: [`Reachability::may_come_near`] says no only when it is sure. The world is
//! cut into square cells. A cell is closed when every place in it is nearer to something solid than
//! the robot's radius: its middle is nearer by half the cell's diagonal. A robot that moves visits
//! one cell after another that touches it, by a side or by a corner; so from the cells where it
//! starts, all cells that it can come to are flooded, through those that are not closed.
//!
//! What is flooded in vain: gaps that are narrower than the robot by less than a cell's diagonal.
//! Cells are a quarter of the radius wide, so that every gap below four fifths of the robot's width
//! is seen to be too narrow. In a world that [`MAX_CELLS`] of these do not cover cells are wider, and
//! once their diagonal is the robot's width, no wall is closed any more.

mod cells;

use crate::geometry::{Disc, Point, Rectangle, Segment};
use cells::Cells;

/// Most cells: a world is covered by larger ones rather than by more.
pub const MAX_CELLS: u32 = 4_000_000;

/// Distances, in metres, that are taken for rounding.
const TOLERANCE_M: f64 = 1e-9;

/// Something that the robot cannot overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Solid {
    /// A wall.
    Wall(Segment),
    /// A pillar.
    Pillar(Disc),
}

/// Where a robot may come to.
#[derive(Debug, Clone)]
pub struct Reachability {
    cells: Cells,
    /// How many cells may be come to before each, row by row, and in all.
    flooded_before: Vec<u32>,
}

impl Reachability {
    /// Where a robot of `radius_m` may come to from anywhere in its `starts` (a single place is a
    /// rectangle from itself to itself), within the walls of `world` and among what is `solid`.
    ///
    /// Takes some bytes a cell, of at most [`MAX_CELLS`], and time with the cells and what is solid.
    #[must_use]
    pub fn new(
        world: Rectangle,
        radius_m: f64,
        solid: impl IntoIterator<Item = Solid>,
        starts: &[Rectangle],
    ) -> Self {
        let cells = Cells::new(world, radius_m);
        let mut is_closed = vec![false; cells.count()];
        // A place is nearer to the solid than the radius if the middle of its cell is by so much.
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

    /// Whether the robot's centre may come within `distance_m` of `point`, 0 for upon it. If not, it
    /// never can. Takes time with the rows of cells that are so near.
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

/// The cells that are come to from those of `starts` through cells that are not closed.
fn flood(cells: &Cells, mut is_closed: Vec<bool>, starts: &[Rectangle]) -> Vec<bool> {
    let mut is_flooded = vec![false; cells.count()];
    let mut ahead: Vec<(u32, u32)> = Vec::new();
    let mut visit = |cell: (u32, u32), ahead: &mut Vec<(u32, u32)>| {
        let index = cells.index(cell);
        // What is flooded is closed behind it, so that it is visited once.
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
