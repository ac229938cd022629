//! Heading sensor: a compass.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A heading in world coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeadingSpec {
    /// Standard deviation, in degrees.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 360.0))]
    pub noise_deg: f64,
}
