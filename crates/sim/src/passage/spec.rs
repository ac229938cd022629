//! The passage of a lane, as a scenario describes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// They pass one after the other. With their statement about the lane, the controllers
/// plan a path along the lane, from one of its short sides to the other, that keeps clear of obstacles and isolated
/// marks, and has the lowest expected number of mines within its width; and they state the risk of each vehicle. If the
/// lane is declared clear, the vehicles drive, and the run continues until each has passed or is destroyed, or until the
/// time limit. Mines that lie outside the lane do nothing to them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PassageSpec {
    /// Width of the path, in metres: a mine whose position is within it can destroy a vehicle.
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub width_m: f64,
    /// Number of vehicles.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 100))]
    pub vehicles: u32,
    /// Speed of the vehicles, in metres per second.
    #[schemars(range(min = 0.01, max = 100.0))]
    pub speed_m_s: f64,
    /// Distance from one vehicle to the next, in metres. Vehicles that were destroyed are bypassed.
    #[serde(default = "twenty")]
    #[schemars(range(min = 0.0, max = 100_000.0))]
    pub gap_m: f64,
    /// Probability that a mine within the width destroys a vehicle, drawn once for each vehicle and mine. By default, it
    /// is that of the hazard of the item.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub destroy_probability: Option<f64>,
}

fn one() -> u32 {
    1
}

fn twenty() -> f64 {
    20.0
}
