//! The expected numbers of mines without a mark, kept for each cell: only messages about a cell change them.
//!
//! Where a robot has driven, a mine would have destroyed it, also one to which all sensors are blind.

use super::coverage::Searched;
use super::settings::{Clearance, Skill};
use alloc::vec;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{Lane, MARK_KINDS};
use core::ops::Range;

/// The ground around an item that has been destroyed in which another one was hidden by it, in square metres: before that, looks
/// at it have shown nothing of the other one.
const HIDDEN_M2: f64 = 0.3;

/// The expected number of mines without a mark in each cell: now, and after one more search in each way.
#[derive(Debug, Clone)]
pub(super) struct Remaining {
    /// The free ground of the lane, in square metres.
    pub(super) free_m2: f64,
    /// The part of all mines that are expected in each cell before a search, and the tile in which it lies.
    shares: Vec<f64>,
    pub(super) tiles: Vec<u32>,
    /// For each way to search, the share of visible mines that one search by each sensor model misses.
    ways: Vec<Vec<f64>>,
    pub(super) now: Vec<f64>,
    pub(super) after: Vec<Vec<f64>>,
}

/// Mines that may lie beside an item that has been destroyed.
#[derive(Debug, Clone, Hashed)]
pub(super) struct Beside {
    cell: usize,
    expected: f64,
    /// The sensor model that has shown them, so that it is not blind to them.
    shown_to: Option<usize>,
    /// The looks of each sensor model until then, in nats: they were at the item.
    nats: Vec<f64>,
}

impl Beside {
    /// In a cell, with the density of mines, or an expected number of mines that marks of a sensor model have shown, whichever
    /// is higher. The place is to be searched again.
    pub(super) fn new(
        cell: usize,
        mines_per_m2: f64,
        shown: Option<(f64, usize)>,
        searched: &Searched,
    ) -> Self {
        let models = 0..searched.models();
        let hidden = mines_per_m2 * HIDDEN_M2;
        let shown = shown.filter(|(further, _)| *further > hidden);
        Self {
            cell,
            expected: shown.map_or(hidden, |(further, _)| further),
            shown_to: shown.map(|(_, model)| model),
            nats: models
                .map(|model| searched.nats_without(model, cell, &[]))
                .collect(),
        }
    }
}

/// What is known of the lane.
pub(super) struct Known<'k> {
    /// For each sensor model, the blind share of each kind.
    pub(super) blind: &'k [[f64; MARK_KINDS]],
    pub(super) searched: &'k Searched,
    /// Where items have been destroyed.
    pub(super) beside: &'k [Beside],
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
            ways: ways.map(|skill| missed_by(clearance, *skill)).collect(),
            now: vec![0.0; lane.cells()],
            after: vec![vec![0.0; lane.cells()]; clearance.searches.len()],
        }
    }

    /// Computes the numbers of some cells again.
    pub(super) fn refresh(&mut self, cells: Range<usize>, clearance: &Clearance, known: &Known) {
        let of_all_kinds = clearance.mines();
        let cells = cells.start..cells.end.min(self.shares.len());
        let near = known.beside.iter();
        let near = near.filter(|beside| cells.contains(&beside.cell) && of_all_kinds > 0.0);
        let near: Vec<&Beside> = near.collect();
        let no_search = vec![1.0; known.blind.len()];
        let mut so_far = no_search.clone();
        for cell in cells {
            for (model, missed) in so_far.iter_mut().enumerate() {
                *missed = libm::exp(-known.searched.nats_without(model, cell, &[]));
            }
            let expected = |search: &[f64]| {
                let left = clearance.hazards().map(|(kind, expected)| {
                    let looks = Looks {
                        kind,
                        cell,
                        known,
                        so_far: &so_far,
                        search,
                    };
                    let destroys = clearance.destroy_probability.get(kind).copied();
                    let survived = 1.0 - destroys.unwrap_or_default() * known.searched.driven(cell);
                    let everywhere = expected * self.shares[cell] * survived * looks.missed(None);
                    let beside = near.iter().filter(|beside| beside.cell == cell);
                    let beside = beside.map(|beside| {
                        beside.expected * expected / of_all_kinds * looks.missed(Some(beside))
                    });
                    everywhere + beside.sum::<f64>()
                });
                left.sum::<f64>()
            };
            self.now[cell] = expected(&no_search);
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

/// The looks at a cell, for a kind of items.
struct Looks<'l> {
    kind: usize,
    cell: usize,
    known: &'l Known<'l>,
    /// The share of visible mines that each sensor model has missed, and that it misses in a further search.
    so_far: &'l [f64],
    search: &'l [f64],
}

impl Looks<'_> {
    /// Share of the mines that all models have missed: of all, or of those beside a destroyed item since then.
    fn missed(&self, beside: Option<&Beside>) -> f64 {
        let models = self.known.blind.iter().enumerate();
        let missed = models.map(|(model, shares)| {
            let is_shown = beside.is_some_and(|beside| beside.shown_to == Some(model));
            let blind = if is_shown { 0.0 } else { shares[self.kind] };
            let so_far = beside.map_or(self.so_far[model], |beside| {
                self.missed_since(beside, model)
            });
            missed_share(blind, so_far * self.search[model])
        });
        missed.product()
    }

    /// Share of visible mines that the looks of a model since the destruction of an item have missed.
    fn missed_since(&self, beside: &Beside, model: usize) -> f64 {
        let before = beside.nats.get(model).copied().unwrap_or_default();
        libm::exp(before - self.known.searched.nats_without(model, self.cell, &[]))
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

/// For each sensor model, the share of visible mines that one search by the best robots that have the skill misses.
fn missed_by(clearance: &Clearance, skill: Skill) -> Vec<f64> {
    let models = clearance.models();
    let mut missed = vec![1.0; models.len()];
    let able = clearance.robots.iter().filter(|robot| robot.has(skill));
    let best = able.max_by(|one, other| one.search_nats.total_cmp(&other.search_nats));
    if let Some(best) = best {
        let index = models.iter().position(|robot| robot.model == best.model);
        missed[index.unwrap_or_default()] = libm::exp(-best.search_nats);
    }
    missed
}

/// Share of items that all looks of a model miss, of those that it is blind to and of the visible ones.
pub(super) fn missed_share(blind: f64, visible: f64) -> f64 {
    blind + (1.0 - blind) * visible
}
