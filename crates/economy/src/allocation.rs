//! The rules by which goals are allocated to robots.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The rule by which a controller allocates its goals to robots.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Allocation {
    /// It awards nothing.
    None,
    /// Each goal to the nearest robot that bids.
    Nearest,
    /// Sequential single-item auction: robots bid the increment of their path.
    #[default]
    Auction,
    /// The assignment of goals to robots, one goal per robot, with the smallest sum of times.
    Optimal,
}
