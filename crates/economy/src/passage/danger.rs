//! The expected losses of one vehicle by mines in each cell of a passage's grid.

use super::grid::{PassageGrid, range};
use super::settings::Passage;
use crate::clearance::{BelievedMark, LanePicture};
use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::FRAC_1_SQRT_2;

/// What has been marked is at most this far from there, in deviations of its position.
const REACH_DEVIATIONS: f64 = 5.0;

/// For each cell of the grid, the expected number of mines there that would destroy the first vehicle over them.
pub(super) fn danger(picture: &LanePicture, passage: &Passage) -> Vec<f64> {
    let mut danger = vec![0.0; passage.grid.cells()];
    let lane = picture.clearance().lane;
    for cell in 0..lane.cells() {
        let losses = passage.losses(picture.unmarked_of_kinds(cell));
        let area = lane.cell_area(cell);
        let (low, high) = (
            passage.grid.coordinates(area.min()),
            passage.grid.coordinates(area.max()),
        );
        let uniform = |axis: usize, from_m: f64, to_m: f64| {
            let side_m = high[axis] - low[axis];
            (to_m.min(high[axis]) - from_m.max(low[axis])).max(0.0) / side_m
        };
        passage.grid.add(&mut danger, losses, [low, high], &uniform);
    }
    for mark in picture.marks().filter(|mark| mark.may_be_in(&lane)) {
        let losses = passage.losses(mark.mine_of_kinds(&lane));
        let at = passage.grid.coordinates(mark.at);
        let reach_m = REACH_DEVIATIONS * mark.deviation_m;
        let bounds = [-reach_m, reach_m].map(|away_m| at.map(|along_m| along_m + away_m));
        let normal = |axis: usize, from_m: f64, to_m: f64| normal(&mark, at[axis], [from_m, to_m]);
        passage.grid.add(&mut danger, losses, bounds, &normal);
    }
    danger
}

impl Passage {
    /// Expected losses of the first vehicle over an expected number of mines of each kind.
    pub(super) fn losses<const KINDS: usize>(&self, mines: [f64; KINDS]) -> f64 {
        let each = mines.iter().zip(&self.effects);
        each.map(|(mines, effect)| mines * effect.destroy_probability)
            .sum()
    }
}

impl PassageGrid {
    /// Distributes an amount over the cells within bounds, by the share that lies in each column and in each row.
    #[expect(clippy::cast_precision_loss, reason = "at most about 65,536 cells")]
    fn add(
        &self,
        to: &mut [f64],
        amount: f64,
        [low, high]: [[f64; 2]; 2],
        share: &dyn Fn(usize, f64, f64) -> f64,
    ) {
        if amount <= 0.0 {
            return;
        }
        let rows = range([low[1], high[1]], self.across_m, self.rows);
        let of_rows = rows.clone().map(|row| {
            let from_m = row as f64 * self.across_m;
            (row, share(1, from_m, from_m + self.across_m))
        });
        let of_rows: Vec<(usize, f64)> = of_rows.collect();
        for column in range([low[0], high[0]], self.along_m, self.columns) {
            let from_m = column as f64 * self.along_m;
            let amount = amount * share(0, from_m, from_m + self.along_m);
            for (row, share) in &of_rows {
                to[column * self.rows + row] += amount * share;
            }
        }
    }
}

/// Probability that one coordinate of what has been marked is between two others.
fn normal(mark: &BelievedMark, at_m: f64, between_m: [f64; 2]) -> f64 {
    let below = |along_m: f64| libm::erf((along_m - at_m) / mark.deviation_m * FRAC_1_SQRT_2) / 2.0;
    below(between_m[1]) - below(between_m[0])
}
