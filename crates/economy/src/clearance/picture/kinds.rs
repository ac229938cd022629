//! The expected mines of each kind.

use super::LanePicture;
use crate::clearance::BelievedMark;
use crate::clearance::remaining::missed_share;
use brain::{Lane, MARK_KINDS};

impl LanePicture {
    /// Expected number of mines of each kind in a cell without a mark; 0 of kinds that do not make the lane unsafe.
    ///
    /// Together, they are the mines of the [cell](Self::unmarked). Their ratio is that of the items which all looks have
    /// missed.
    pub(crate) fn unmarked_of_kinds(&self, cell: usize) -> [f64; MARK_KINDS] {
        let mut weights = [0.0; MARK_KINDS];
        let mut hazards = self.clearance.hazards();
        if let (Some((only, _)), None) = (hazards.next(), hazards.next()) {
            weights[only] = 1.0;
        } else {
            for (kind, expected) in self.clearance.hazards() {
                let missed = self.blind.iter().enumerate().map(|(model, shares)| {
                    missed_share(shares[kind], self.searched.nats_without(model, cell, &[]))
                });
                weights[kind] = expected * missed.product::<f64>();
            }
        }
        let total: f64 = weights.iter().sum();
        let expected = self.unmarked(cell);
        weights.map(|weight| {
            if total > 0.0 {
                expected * weight / total
            } else {
                0.0
            }
        })
    }
}

impl BelievedMark {
    /// Probability of a mine of each kind there that has not been neutralised.
    pub(crate) fn mine_of_kinds(&self, lane: &Lane) -> [f64; MARK_KINDS] {
        let mines = self.hazards_of(lane);
        let total: f64 = mines.iter().sum();
        mines.map(|mine| {
            if total > 0.0 {
                self.mine * mine / total
            } else {
                0.0
            }
        })
    }

    /// Probability of each kind of items there that make a lane unsafe; 0 of the others.
    pub(crate) fn hazards_of(&self, lane: &Lane) -> [f64; MARK_KINDS] {
        core::array::from_fn(|kind| {
            if lane.is_hazard(kind) {
                self.probabilities[kind]
            } else {
                0.0
            }
        })
    }
}
