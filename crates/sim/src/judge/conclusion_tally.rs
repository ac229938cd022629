//! What controllers stated of a lane beside the risk, and the truth at that time.

use base::hashed::Hashed;
use economy::PlannedPassage;

/// What was stated of a lane when it was declared clear or given up.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub(crate) struct ConclusionTally {
    /// Of each kind that makes the lane unsafe.
    pub(crate) cleared: Vec<StatedClearance>,
    /// The path on which vehicles are to pass.
    pub(crate) passage: Option<PlannedPassage>,
    /// Mines within the width of that path.
    pub(crate) mines_on_path: u32,
}

/// The share of the mines of a kind that are cleared.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub struct StatedClearance {
    /// The number of the kind of items.
    pub kind: usize,
    /// The share that was stated, and the interval that contains it with a probability of at least 95%.
    pub stated: f64,
    /// Lower end of that interval.
    pub low: f64,
    /// Upper end of that interval.
    pub high: f64,
    /// The true share; 1 if the lane held none.
    pub truth: f64,
}
