//! What a controller states of a lane beside the risk that a mine is left.

use crate::clearance::{ClearedShare, LanePicture};
use crate::passage::{Passage, PlannedPassage};
use alloc::vec::Vec;
use base::hashed::Hashed;

/// What a controller states of a lane with its [statement](crate::LaneStatement).
#[derive(Debug, Clone, PartialEq, Hashed)]
pub struct LaneConclusion {
    /// The share of the mines that are cleared, for each kind that makes the lane unsafe.
    pub cleared: Vec<ClearedShare>,
    /// The path on which vehicles are to pass, if any are to, and if there is one.
    pub passage: Option<PlannedPassage>,
}

impl LaneConclusion {
    /// What follows from a picture of the lane.
    pub(super) fn new(picture: &LanePicture, passage: Option<&Passage>) -> Self {
        Self {
            cleared: picture.cleared(),
            passage: passage.and_then(|passage| PlannedPassage::new(passage, picture)),
        }
    }
}
