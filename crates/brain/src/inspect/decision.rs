//! The decision of a brain in one step, and its reasons.

use super::belief_state::BeliefState;
use crate::io::command::Command;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The decision of a brain in one step, and its reasons.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Decision {
    /// The command.
    pub command: Command,
    /// Index of the active behaviour in the brain's list; none if there is nothing to do, or if all
    /// are blended.
    pub leading: Option<u32>,
    /// Remaining hold time of each behaviour.
    pub holds_s: Vec<f64>,
    /// Its beliefs and goals; none without beliefs.
    pub belief_state: Option<BeliefState>,
}
