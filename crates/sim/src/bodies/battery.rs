//! What a battery holds, and what drains it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A battery and what the body takes from it; sensors and radio take more.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BatterySpec {
    /// Energy when full, in joules; left out, it never empties and is only counted.
    #[schemars(range(min = 0.001, max = 1e12))]
    pub capacity_j: Option<f64>,
    /// Power of the computer and all else that is always on, in watts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub idle_w: f64,
    /// More power while it moves or turns, in watts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub move_w: f64,
    /// More energy for each metre without payload, in joules; a payload adds its share of the mass.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub move_j_per_m: f64,
}

/// A battery, as the step needs it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Battery {
    /// Infinite if it never empties.
    pub(crate) capacity_j: f64,
    pub(crate) idle_w: f64,
    pub(crate) move_w: f64,
    /// With its payload.
    pub(crate) move_j_per_m: f64,
}

impl Battery {
    pub(crate) fn new(spec: &BatterySpec, (mass_kg, payload_kg): (f64, f64)) -> Self {
        let mass = (mass_kg + payload_kg) / mass_kg;
        Self {
            capacity_j: spec.capacity_j.unwrap_or(f64::INFINITY),
            idle_w: spec.idle_w,
            move_w: spec.move_w,
            move_j_per_m: spec.move_j_per_m * mass,
        }
    }
}
