//! Where the robots of a run start.

use crate::heading::Heading;
use crate::robot::{Speed, Start};
use crate::world::{CELL_PX, Cell};
use base::random::{Entity, Purpose, stream};

/// Robots that a team may have: what a grid cell of the fast form can count.
pub const MAX_ROBOTS: u32 = 250;

/// First of the columns (and rows) on which a robot may start.
pub const FIRST_CELL: u8 = 4;

/// How many columns (and rows) those are: 4 to 20.
pub const START_CELLS: u8 = 17;

/// Where robot `index` stands at the start of a run: it depends on nothing else than these three,
/// so that teams of different size share their robots' starts.
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

/// A team on these cells, as the original starts it: speed 1, robot i heading 45 degrees x i.
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
