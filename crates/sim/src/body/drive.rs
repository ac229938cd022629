//! How a body moves: a differential drive with limits, along exact arcs.

use brain::Motion;
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

/// A drive's limits, as the step needs them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drive {
    pub(crate) max_speed_m_s: f64,
    pub(crate) max_reverse_speed_m_s: f64,
    /// Infinite if speed changes at once.
    pub(crate) max_acceleration_m_s2: f64,
    pub(crate) max_turn_rate_rad_s: f64,
}

impl From<&DriveSpec> for Drive {
    fn from(spec: &DriveSpec) -> Self {
        Self {
            max_speed_m_s: spec.max_speed_m_s,
            max_reverse_speed_m_s: spec.max_reverse_speed_m_s,
            max_acceleration_m_s2: spec.max_acceleration_m_s2.unwrap_or(f64::INFINITY),
            max_turn_rate_rad_s: spec.max_turn_rate_deg_s.to_radians(),
        }
    }
}

impl Drive {
    /// What the body does of what is wanted: the speed after the step, how far it goes in it, and
    /// its rate of turn.
    ///
    /// The speed changes as fast as it may until it is as wanted, and then stays; `terrain` is a
    /// factor on the greatest speeds. Nothing that is not a number is wanted.
    #[inline]
    pub(crate) fn step(&self, speed_m_s: f64, wanted: Motion, terrain: f64, step_s: f64) -> Driven {
        let least = -self.max_reverse_speed_m_s * terrain;
        let most = self.max_speed_m_s * terrain;
        let after = or_zero(wanted.speed_m_s).max(least).min(most);
        let most_turn = self.max_turn_rate_rad_s;
        let turn_rate_rad_s = or_zero(wanted.turn_rate_rad_s)
            .max(-most_turn)
            .min(most_turn);
        let change = after - speed_m_s;
        let change_s = change.abs() / self.max_acceleration_m_s2;
        if change_s <= step_s {
            // On average the speed is half way for the time of the change.
            let length_m = after * step_s - change * change_s / 2.0;
            return Driven {
                speed_m_s: after,
                turn_rate_rad_s,
                length_m,
            };
        }
        let after = speed_m_s + self.max_acceleration_m_s2.copysign(change) * step_s;
        Driven {
            speed_m_s: after,
            turn_rate_rad_s,
            length_m: (speed_m_s + after) / 2.0 * step_s,
        }
    }
}

/// How a body drives in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Driven {
    /// At the end of the step.
    pub(crate) speed_m_s: f64,
    pub(crate) turn_rate_rad_s: f64,
    /// Ahead; negative is backwards.
    pub(crate) length_m: f64,
}

impl Driven {
    pub(crate) const REST: Self = Self {
        speed_m_s: 0.0,
        turn_rate_rad_s: 0.0,
        length_m: 0.0,
    };
}

fn or_zero(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}
