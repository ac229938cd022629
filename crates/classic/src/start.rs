//! Random starts of the robots of a run.

use crate::heading::Heading;
use crate::robot::{Speed, Start};
use crate::world::{CELL_PX, Cell};
use base::random::{Entity, Purpose, stream};

/// Maximum team size: the largest count of a grid cell in the fast form.
pub const MAX_ROBOTS: u32 = 250;

/// First column (and row) on which a robot may start.
pub const FIRST_CELL: u8 = 4;

/// Number of these columns (and rows): 4 to 20.
pub const START_CELLS: u8 = 17;

/// The start cell of robot `index` in a run. It depends on these three arguments only, so that teams of
/// different sizes share the starts of their robots.
#[must_use]
#[inline]
pub fn random_cell(seed: u64, run: u64, index: u32) -> Cell {
    let mut draws = stream(seed, run, Entity { kind: 0, index }, Purpose::Start);
    let mut coordinate = || i32::from(FIRST_CELL) + draws.bounded(START_CELLS.into()).cast_signed();
    Cell {
        x: coordinate(),
        y: coordinate(),
    }
}

/// A team's starts in one run of one seed.
#[must_use]
pub fn random_team(robots: u32, seed: u64, run: u64) -> Vec<Start> {
    let cells = (0..robots).map(|index| random_cell(seed, run, index));
    team_on(&cells.collect::<Vec<_>>())
}

/// A team on these cells, as in the original: speed 1, and heading 45 degrees x i for robot i.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "cells are small whole numbers")]
pub fn team_on(cells: &[Cell]) -> Vec<Start> {
    let start = |(index, cell): (usize, &Cell)| Start {
        x_px: cell.x as f32 * CELL_PX,
        y_px: cell.y as f32 * CELL_PX,
        heading: Heading::of_octant(index),
        speed: Speed::Slow,
    };
    cells.iter().enumerate().map(start).collect()
}
