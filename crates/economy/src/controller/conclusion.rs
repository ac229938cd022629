//! What a controller states of a lane beside the risk that a mine is left.

use crate::clearance::ClearedShare;
use crate::passage::PlannedPassage;
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
