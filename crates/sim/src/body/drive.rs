//! How a body moves: a differential drive with limits, along exact arcs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a body's drive can do.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DriveSpec {
    /// At most so fast ahead, in m/s.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub max_speed_m_s: f64,
    /// At most so fast backwards, in m/s; 0 if it cannot.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub max_reverse_speed_m_s: f64,
    /// It gains and loses speed at most so fast, in m/s²; left out, speed changes at once.
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub max_acceleration_m_s2: Option<f64>,
    /// It turns at most so fast, in degrees a second.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub max_turn_rate_deg_s: f64,
}
