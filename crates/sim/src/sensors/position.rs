//! Position sensor: a satellite receiver.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A position in world coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PositionSpec {
    /// Standard deviation along each axis, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
}
