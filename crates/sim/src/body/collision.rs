//! What a collision costs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What happens to a robot that touches something.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct CollisionSpec {
    /// It stands still for so long, in seconds.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub stop_s: f64,
    /// It is broken after so many collisions; left out, it never breaks.
    #[schemars(range(min = 1))]
    pub breaks_after: Option<u32>,
}
