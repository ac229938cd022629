//! Battery capacity and power draw.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A battery and the power that the body draws; sensors and radio draw more.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BatterySpec {
    /// Capacity, in joules. Without it the battery never runs empty and energy is only counted.
    #[schemars(range(min = 0.001, max = 1e12))]
    pub capacity_j: Option<f64>,
    /// Constant power of the computer and other electronics, in watts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub idle_w: f64,
    /// Additional power while the robot moves or turns, in watts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub move_w: f64,
    /// Additional energy per metre without payload, in joules; a payload raises it in proportion to
    /// the total mass.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub move_j_per_m: f64,
}

/// A battery, converted for the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Battery {
    /// Infinite if it never runs empty.
    pub(crate) capacity_j: f64,
    pub(crate) idle_w: f64,
    pub(crate) move_w: f64,
    /// Including the payload.
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
