//! What a person sets of a controller.

use crate::allocation::Allocation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The settings of all controllers of a kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// The rule by which it allocates its goals to robots.
    pub allocation: Allocation,
    /// Time for which a robot may serve a goal without renewal.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub service_lease_s: f64,
    /// Time for which a controller owns a goal without renewal by its heir.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub owner_lease_s: f64,
    /// Time from a call for bids to the award.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub auction_s: f64,
    /// Maximum number of goals that it owns; more are refused.
    #[schemars(range(max = 10_000))]
    pub max_goals: u32,
    /// Maximum drift of any clock, in seconds per second.
    #[schemars(range(min = 0.0, max = 0.1))]
    pub max_drift: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            allocation: Allocation::default(),
            service_lease_s: 20.0,
            owner_lease_s: 30.0,
            auction_s: 1.0,
            max_goals: 1000,
            max_drift: 1e-4,
        }
    }
}
