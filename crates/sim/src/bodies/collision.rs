//! Consequences of a collision.

use crate::schedule::steps_of;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Consequences of a collision for a robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct CollisionSpec {
    /// Time for which the robot is stopped after a collision, in seconds.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub stop_duration_s: f64,
    /// The robot breaks down after this number of collisions. Without it, never.
    #[schemars(range(min = 1))]
    pub max_collisions: Option<u32>,
}

/// Consequences of a collision, converted for the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Collision {
    pub(crate) stop_steps: u64,
    pub(crate) max_collisions: u32,
}

impl Collision {
    pub(crate) fn new(spec: &CollisionSpec, step_s: f64) -> Self {
        Self {
            stop_steps: steps_of(spec.stop_duration_s, step_s),
            max_collisions: spec.max_collisions.unwrap_or(u32::MAX),
        }
    }
}
