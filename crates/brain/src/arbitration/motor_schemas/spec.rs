//! Parameters of motor schemas.

use alloc::collections::BTreeMap;
use alloc::string::String;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of motor schemas.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Schemas {
    /// Weight of a behaviour, by its kind. Without it, its `value`, or 1 if it has none.
    pub gains: BTreeMap<String, f64>,
    /// Obstacles nearer to the robot's footprint than this repel it, in metres; the nearer, the
    /// more.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub influence_m: f64,
    /// Weight of an obstacle at contact, relative to 1 for all behaviours together.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub repulsion: f64,
    /// Weight of a random direction, relative to 1 for all behaviours together.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise: f64,
    /// While the robot is blocked, `noise` grows to this, and then falls again. Without effect if
    /// not above `noise`.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub max_noise: f64,
    /// A random direction is kept for this long, in seconds.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub noise_s: f64,
    /// The robot is blocked when a motion is proposed and it has not left a circle of this radius,
    /// in metres, for `blocked_after_s`.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub blocked_within_m: f64,
    /// Time after which the robot is blocked, in seconds. The noise takes as long to grow, and four
    /// times as long to fall.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub blocked_after_s: f64,
}

impl Default for Schemas {
    fn default() -> Self {
        Self {
            gains: BTreeMap::new(),
            influence_m: 1.0,
            repulsion: 2.0,
            noise: 0.1,
            max_noise: 3.0,
            noise_s: 4.0,
            blocked_within_m: 2.0,
            blocked_after_s: 5.0,
        }
    }
}
