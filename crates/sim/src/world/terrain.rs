//! What the ground is like.

use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A class of ground, for ground robots; where two overlap, the one last by name holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TerrainSpec {
    /// Factor on the greatest speed.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub speed: f64,
    /// Factor on the energy of moving.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub energy: f64,
    /// Polygons, each a list of corners in order, in metres.
    pub areas_m: Vec<Vec<Point>>,
}

fn one() -> f64 {
    1.0
}
