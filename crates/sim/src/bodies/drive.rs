//! Differential drive with limits, along exact arcs.

use brain::Motion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Limits of a differential drive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DriveSpec {
    /// Maximum forward speed, in m/s.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub max_speed_m_s: f64,
    /// Maximum reverse speed, in m/s; 0 if the robot cannot reverse.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub max_reverse_speed_m_s: f64,
    /// Maximum acceleration and deceleration, in m/s². Without it, speed changes instantly.
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub max_acceleration_m_s2: Option<f64>,
    /// Maximum turn rate, in degrees per second. Without it, the robot first turns instantly by any
    /// angle and then drives straight.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub max_turn_rate_deg_s: Option<f64>,
}

/// Limits of a drive, converted for the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drive {
    pub(crate) max_speed_m_s: f64,
    pub(crate) max_reverse_speed_m_s: f64,
    /// Infinite if speed changes instantly.
    pub(crate) max_acceleration_m_s2: f64,
    pub(crate) max_turn_rate_rad_s: f64,
    /// Whether the turn of a step happens at its beginning.
    pub(crate) turns_at_once: bool,
}

impl Drive {
    pub(crate) fn new(spec: &DriveSpec, step_s: f64) -> Self {
        // No heading differs by more than half a turn.
        let at_once_rad_s = std::f64::consts::PI / step_s;
        let turn_rate = spec.max_turn_rate_deg_s.map(f64::to_radians);
        Self {
            max_speed_m_s: spec.max_speed_m_s,
            max_reverse_speed_m_s: spec.max_reverse_speed_m_s,
            max_acceleration_m_s2: spec.max_acceleration_m_s2.unwrap_or(f64::INFINITY),
            max_turn_rate_rad_s: turn_rate.unwrap_or(at_once_rad_s),
            turns_at_once: turn_rate.is_none(),
        }
    }

    /// The motion of the body in one step, given the motion setpoint of the brain: the speed at the
    /// end of the step, the distance, and the turn rate.
    ///
    /// The speed changes at the maximum acceleration until the setpoint is reached, and then stays
    /// constant. `terrain` scales the maximum speeds. Non-finite values count as 0.
    #[inline]
    pub(crate) fn step(
        &self,
        speed_m_s: f64,
        setpoint: Motion,
        terrain: f64,
        step_s: f64,
    ) -> Driven {
        let after = self.possible(or_zero(setpoint.speed_m_s), terrain);
        let max_turn = self.max_turn_rate_rad_s;
        let turn_rate_rad_s = or_zero(setpoint.turn_rate_rad_s)
            .max(-max_turn)
            .min(max_turn);
        let change = after - speed_m_s;
        let change_s = change.abs() / self.max_acceleration_m_s2;
        if change_s <= step_s {
            // While the speed changes, its mean is half way between both.
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
            length_m: f64::midpoint(speed_m_s, after) * step_s,
        }
    }
}

impl Drive {
    /// The nearest possible speed where `terrain` scales the maximum speeds.
    #[inline]
    pub(crate) fn possible(&self, speed_m_s: f64, terrain: f64) -> f64 {
        let least = -self.max_reverse_speed_m_s * terrain;
        let most = self.max_speed_m_s * terrain;
        speed_m_s.max(least).min(most)
    }
}

/// The motion of a body in one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Driven {
    /// At the end of the step.
    pub(crate) speed_m_s: f64,
    pub(crate) turn_rate_rad_s: f64,
    /// Forward; negative is reverse.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ROVER: Drive = Drive {
        max_speed_m_s: 2.0,
        max_reverse_speed_m_s: 1.0,
        max_acceleration_m_s2: 4.0,
        max_turn_rate_rad_s: 1.5,
        turns_at_once: false,
    };

    fn motion(speed_m_s: f64, turn_rate_rad_s: f64) -> Motion {
        Motion {
            speed_m_s,
            turn_rate_rad_s,
        }
    }

    /// Distance covered in a number of steps until the body has stopped.
    fn stopping_m(drive: &Drive, speed_m_s: f64, step_s: f64) -> f64 {
        let (mut speed, mut way) = (speed_m_s, 0.0);
        while speed != 0.0 {
            let driven = drive.step(speed, Motion::default(), 1.0, step_s);
            (speed, way) = (driven.speed_m_s, way + driven.length_m);
        }
        way
    }

    #[test]
    fn the_stopping_distance_is_that_of_the_closed_form_for_any_step() {
        for step_s in [0.001, 0.07, 0.1, 0.3, 2.0] {
            // v^2 / (2 a), forward and in reverse.
            assert!(
                (stopping_m(&ROVER, 2.0, step_s) - 0.5).abs() < 1e-12,
                "{step_s}"
            );
            assert!(
                (stopping_m(&ROVER, -1.0, step_s) + 0.125).abs() < 1e-12,
                "{step_s}"
            );
        }
    }

    proptest! {
        #[test]
        fn the_way_is_the_integral_of_the_speed(
            speed in -1.0..2.0, setpoint in -3.0..3.0, terrain in 0.0..3.0, step in 0.01..2.0,
        ) {
            let driven = ROVER.step(speed, motion(setpoint, 0.0), terrain, step);
            let (parts, mut now, mut way) = (20_000, speed, 0.0);
            let target = setpoint.clamp(-terrain, 2.0 * terrain);
            let part_s = step / f64::from(parts);
            for _ in 0..parts {
                let next = now + (target - now).clamp(-4.0 * part_s, 4.0 * part_s);
                way += f64::midpoint(now, next) * part_s;
                now = next;
            }
            prop_assert!((driven.speed_m_s - now).abs() < 1e-9);
            prop_assert!((driven.length_m - way).abs() < 1e-6, "{} {way}", driven.length_m);
        }

        #[test]
        fn a_drive_keeps_its_limits_whatever_is_wanted(
            speed: f64, turn: f64, now in -1.0..2.0, step in 0.001..10.0,
        ) {
            let driven = ROVER.step(now, motion(speed, turn), 1.0, step);
            prop_assert!((-1.0..=2.0).contains(&driven.speed_m_s));
            prop_assert!((driven.speed_m_s - now).abs() <= 4.0 * step + 1e-12);
            prop_assert!(driven.turn_rate_rad_s.abs() <= 1.5);
            prop_assert!((-step..=2.0 * step).contains(&driven.length_m));
        }
    }

    #[test]
    fn without_a_limit_speed_changes_at_once() {
        let drive = Drive {
            max_acceleration_m_s2: f64::INFINITY,
            ..ROVER
        };
        let driven = drive.step(-1.0, motion(2.0, 0.5), 1.0, 0.1);
        assert_eq!(driven.speed_m_s, 2.0);
        assert_eq!(driven.length_m, 2.0 * 0.1);
        assert_eq!(driven.turn_rate_rad_s, 0.5);
    }

    #[test]
    fn nothing_that_is_not_a_number_is_wanted() {
        let nan = motion(f64::NAN, f64::NAN);
        assert_eq!(ROVER.step(0.0, nan, 1.0, 0.1), Driven::REST);
        let infinite = motion(f64::NEG_INFINITY, f64::INFINITY);
        let driven = ROVER.step(-1.0, infinite, 1.0, 0.1);
        assert_eq!((driven.speed_m_s, driven.turn_rate_rad_s), (-1.0, 1.5));
    }
}
