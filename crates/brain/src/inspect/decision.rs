//! What a brain decides in one step, and why, for whoever looks at it.

use super::belief_state::BeliefState;
use crate::io::command::Command;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a brain decides in one step, and why.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Decision {
    /// What the robot is to do.
    pub command: Command,
    /// Place in the brain's list of the behaviour that has its way; none if nothing is to be done, or all
    /// count together.
    pub leading: Option<u32>,
    /// For so long each behaviour keeps control though it has nothing to do.
    pub holds_s: Vec<f64>,
    /// What it believes and wants; none if it has no mind.
    pub thoughts: Option<BeliefState>,
}
