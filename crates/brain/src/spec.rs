//! What a scenario says of a brain.

use crate::arbitration::Arbitration;
use crate::behaviours::{Avoid, BehaviourSpec, Cruise, RandomBounce};
use crate::perception::beliefs::BeliefsSpec;
use alloc::vec;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A robot's mind: behaviours one above the other, of which the highest that has something to do
/// has its way (subsumption: Brooks, *A robust layered control system for a mobile robot*, 1986).
///
/// Left out, it goes ahead, turns to a random course at obstacles, and gets out of the way of what
/// is too near: a search that works anywhere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BrainSpec {
    /// Times a second that it thinks; left out, at every step of the simulation.
    #[schemars(range(min = 0.0001, max = 10_000.0))]
    pub rate_hz: Option<f64>,
    /// Whether it goes only so fast that it can stop within what its range sensors see to be free.
    /// It then stands when they see nothing, and can still hit what slips between two rays. A robot
    /// without a range sensor that looks where it goes is blind, and is not limited.
    pub limit_speed_to_stopping_distance: bool,
    /// How one motion is made of what all behaviours want.
    pub arbitration: Arbitration,
    /// What it believes of the world; left out, it has what its behaviours need.
    pub beliefs: Option<BeliefsSpec>,
    /// Its behaviours, the lowest first.
    #[schemars(length(max = 32))]
    pub behaviours: Vec<BehaviourSpec>,
}

impl Default for BrainSpec {
    fn default() -> Self {
        Self {
            rate_hz: None,
            limit_speed_to_stopping_distance: true,
            arbitration: Arbitration::default(),
            beliefs: None,
            behaviours: vec![
                BehaviourSpec::Cruise(Cruise::default()),
                BehaviourSpec::RandomBounce(RandomBounce::default()),
                BehaviourSpec::Avoid(Avoid::default()),
            ],
        }
    }
}
