//! The expected numbers of mines without a mark, kept for each cell: only messages about a cell change them.
//!
//! Where a robot has driven, a mine would have destroyed it, also one to which all sensors are blind.

use super::coverage::Searched;
use super::settings::{Clearance, Skill};
use alloc::vec;
use alloc::vec::Vec;
use brain::{HAS_ANOTHER, Lane, MARK_KINDS};
use core::ops::Range;

/// The expected number of mines without a mark in each cell: now, and after one more search in each way.
#[derive(Debug, Clone)]
pub(super) struct Remaining {
    /// The free ground of the lane, in square metres.
    pub(super) free_m2: f64,
    /// The part of all mines that are expected in each cell before a search, and the tile in which it lies.
    shares: Vec<f64>,
    pub(super) tiles: Vec<u32>,
    /// For each way to search, the looks of one search by each sensor model, in nats.
    ways: Vec<Vec<f64>>,
    pub(super) now: Vec<f64>,
    pub(super) after: Vec<Vec<f64>>,
}

impl Remaining {
    pub(super) fn new(clearance: &Clearance) -> Self {
        let lane = clearance.lane;
        let tiles = clearance.tiles();
        let free_m2 = clearance.free_area_m2();
        let cells = 0..lane.cells();
        let tile = |cell| u32::try_from(tiles.nearest_cell(lane.centre(cell))).unwrap_or(u32::MAX);
        let shares = cells.clone();
        let shares = shares.map(|cell| clearance.free_m2(cell) / free_m2);
        let ways = clearance.searches.iter();
        Self {
            free_m2,
            shares: shares.collect(),
            tiles: cells.map(tile).collect(),
            ways: ways.map(|skill| nats_of(clearance, *skill)).collect(),
            now: vec![0.0; lane.cells()],
            after: vec![vec![0.0; lane.cells()]; clearance.searches.len()],
        }
    }

    /// Takes that an item in a cell has been destroyed, with an expected number of further mines beside it: another one may
    /// lie there that no mark shows.
    pub(super) fn note_destroyed(&mut self, cell: usize, further: f64, clearance: &Clearance) {
        let expected: f64 = clearance.hazards().map(|(_, expected)| expected).sum();
        if let Some(share) = self.shares.get_mut(cell).filter(|_| expected > 0.0) {
            *share += further.max(HAS_ANOTHER) / expected;
        }
    }

    /// Computes the numbers of some cells again.
    pub(super) fn refresh(
        &mut self,
        cells: Range<usize>,
        clearance: &Clearance,
        (blind, searched): (&[[f64; MARK_KINDS]], &Searched),
    ) {
        for cell in cells.start..cells.end.min(self.shares.len()) {
            let share = self.shares[cell];
            let expected = |more_nats: &[f64]| {
                let left = clearance.hazards().map(|(kind, expected)| {
                    let missed = blind.iter().enumerate().map(|(model, shares)| {
                        let nats = searched.nats_without(model, cell, &[]);
                        let more_nats = more_nats.get(model).copied().unwrap_or_default();
                        missed_share(shares[kind], nats + more_nats)
                    });
                    let destroys = clearance.destroy_probability.get(kind).copied();
                    let survived = 1.0 - destroys.unwrap_or_default() * searched.driven(cell);
                    expected * share * survived * missed.product::<f64>()
                });
                left.sum::<f64>()
            };
            self.now[cell] = expected(&[]);
            for ((way, skill), after) in self
                .ways
                .iter()
                .zip(&clearance.searches)
                .zip(&mut self.after)
            {
                after[cell] = if clearance.can_see(*skill, cell) {
                    expected(way)
                } else {
                    self.now[cell]
                };
            }
        }
    }
}

impl Clearance {
    /// The tiles that are searched as one goal.
    pub(crate) fn tiles(&self) -> Lane {
        Lane {
            cell_m: self.tile_m,
            ..self.lane
        }
    }
}

/// For each sensor model, the looks of one search by the best robots that have the skill.
fn nats_of(clearance: &Clearance, skill: Skill) -> Vec<f64> {
    let models = clearance.models();
    let mut nats = vec![0.0; models.len()];
    let able = clearance.robots.iter().filter(|robot| robot.has(skill));
    let best = able.max_by(|one, other| one.search_nats.total_cmp(&other.search_nats));
    if let Some(best) = best {
        let index = models.iter().position(|robot| robot.model == best.model);
        nats[index.unwrap_or_default()] = best.search_nats;
    }
    nats
}

/// Share of items that all looks of a model miss.
pub(super) fn missed_share(blind: f64, nats: f64) -> f64 {
    blind + (1.0 - blind) * libm::exp(-nats)
}
