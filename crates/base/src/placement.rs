//! Where things are put. (Stub until the real one is merged.)
use crate::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where things are put.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Placement {
    /// At these places.
    Fixed {
        /// Places.
        at_m: Vec<Point>,
    },
    /// Anywhere.
    Uniform {},
}
impl Default for Placement {
    fn default() -> Self {
        Self::Uniform {}
    }
}
