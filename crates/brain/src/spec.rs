//! The part of a scenario that describes a brain.

use crate::arbitration::Arbitration;
use crate::behaviours::{Avoid, BehaviourSpec, Cruise, RandomBounce};
use crate::goals::proposal::max_deviation_m;
use crate::perception::beliefs::BeliefsSpec;
use alloc::vec;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The brain of a robot: a list of behaviours, and how one motion results from them. By default the
/// highest behaviour with something to do controls the robot (subsumption: Brooks, *A robust
/// layered control system for a mobile robot*, 1986).
///
/// Without behaviours of its own, a robot moves straight on, turns to a random free heading at
/// obstacles, and avoids what is too near: a search that works anywhere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BrainSpec {
    /// Steps of the brain per second; without it, one per time step of the simulation.
    #[schemars(range(min = 0.0001, max = 10_000.0))]
    pub rate_hz: Option<f64>,
    /// Whether the speed is limited so that the robot can stop within what its range sensors see to
    /// be free. The older the last scan, the slower it drives; without one it stops. It can still
    /// hit what lies between two rays, or moves. A robot without a range sensor in its direction of
    /// motion is not limited.
    pub limit_speed_to_stopping_distance: bool,
    /// How one motion results from the behaviours.
    pub arbitration: Arbitration,
    /// What the robot believes of the world. Without it, the beliefs that its behaviours need.
    pub beliefs: Option<BeliefsSpec>,
    /// The behaviours, the lowest first.
    #[schemars(length(max = 32))]
    pub behaviours: Vec<BehaviourSpec>,
}

impl BrainSpec {
    /// The smallest distance within which one of its behaviours has reached a waypoint; `None` without
    /// waypoints.
    #[must_use]
    pub fn within_m(&self) -> Option<f64> {
        let distances = self.behaviours.iter().filter_map(BehaviourSpec::within_m);
        distances.reduce(f64::min)
    }

    /// Whether one position with this standard deviation is not enough to know that a waypoint is
    /// reached.
    #[must_use]
    pub fn needs_filter(&self, position_error_m: f64) -> bool {
        let is_uncertain = |within_m| position_error_m > max_deviation_m(within_m);
        self.within_m().is_some_and(is_uncertain)
    }
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
