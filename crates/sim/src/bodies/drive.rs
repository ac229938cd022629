//! Differential drive with limits and errors, along exact arcs.

pub(crate) mod delay;
mod gains;
mod lag;

use brain::Motion;
use delay::{Delay, SetpointQueue};
use gains::Gains;
use lag::{Followed, Lag};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Limits and errors of a differential drive.
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
    /// Time constant of the first-order lag with which speed and turn rate follow their setpoints, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub lag_s: f64,
    /// Time from a setpoint until its effect begins, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub delay_s: f64,
    /// Factor on speed and turn rate: 1.2 makes the robot 20% faster than its setpoints and its limits.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub gain: f64,
    /// Ratio of the gain of the left track or wheel to that of the right one. Their mean is `gain`. It requires
    /// `max_turn_rate_deg_s`.
    #[serde(default = "one")]
    #[schemars(range(min = 0.1, max = 10.0))]
    pub gain_left_right: f64,
    /// Distance between the tracks or wheels, in metres; only `gain_left_right` depends on it. Without it, the
    /// diameter of the robot.
    #[schemars(range(min = 0.001, max = 100.0))]
    pub track_width_m: Option<f64>,
    /// Whether the robot measures its speed and turn rate. Without it, true for a drive without errors (lag, delay,
    /// gains), and false for one with any.
    pub odometry: Option<bool>,
}

impl DriveSpec {
    /// Whether it executes setpoints with errors.
    pub(crate) fn has_errors(&self) -> bool {
        let has_time = self.lag_s > 0.0 || self.delay_s > 0.0;
        has_time || !is_one(self.gain) || !self.has_equal_tracks()
    }

    /// Whether both tracks have the same gain.
    pub(crate) fn has_equal_tracks(&self) -> bool {
        is_one(self.gain_left_right)
    }

    /// The distance between the tracks of a robot of this radius.
    pub(crate) fn track_width_m(&self, radius_m: f64) -> f64 {
        self.track_width_m.unwrap_or(2.0 * radius_m)
    }
}

/// Limits and errors of a drive, converted for the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drive {
    pub(crate) max_speed_m_s: f64,
    pub(crate) max_reverse_speed_m_s: f64,
    /// Infinite if speed changes instantly.
    pub(crate) max_acceleration_m_s2: f64,
    pub(crate) max_turn_rate_rad_s: f64,
    /// Whether the turn of a step happens at its beginning.
    pub(crate) turns_at_once: bool,
    /// Whether the robot measures its speed and turn rate.
    pub(crate) has_odometry: bool,
    /// How it executes setpoints; `None` if exactly.
    pub(crate) errors: Option<DriveErrors>,
}

/// How a drive executes setpoints: after a delay, with gains, and with a lag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DriveErrors {
    delay: Delay,
    gains: Gains,
    lag: Option<Lag>,
    /// Whether earlier steps have an effect on later ones, besides by the speed.
    pub(crate) has_memory: bool,
}

impl DriveErrors {
    fn new(spec: &DriveSpec, radius_m: f64, step_s: f64) -> Self {
        let width_m = spec.track_width_m(radius_m);
        Self {
            delay: Delay::new(spec.delay_s, step_s),
            gains: Gains::new(spec.gain, spec.gain_left_right, width_m),
            lag: Lag::new(spec.lag_s, step_s),
            has_memory: spec.delay_s > 0.0 || spec.lag_s > 0.0,
        }
    }

    /// The setpoints that its delay keeps, if it needs any.
    pub(crate) fn queue(&self, setpoint: Motion) -> Option<SetpointQueue> {
        self.has_memory
            .then(|| SetpointQueue::new(self.delay, setpoint))
    }
}

impl Drive {
    pub(crate) fn new(spec: &DriveSpec, radius_m: f64, step_s: f64) -> Self {
        let has_errors = spec.has_errors();
        // No heading differs by more than half a turn.
        let at_once_rad_s = std::f64::consts::PI / step_s;
        let turn_rate = spec.max_turn_rate_deg_s.map(f64::to_radians);
        Self {
            max_speed_m_s: spec.max_speed_m_s,
            max_reverse_speed_m_s: spec.max_reverse_speed_m_s,
            max_acceleration_m_s2: spec.max_acceleration_m_s2.unwrap_or(f64::INFINITY),
            max_turn_rate_rad_s: turn_rate.unwrap_or(at_once_rad_s),
            turns_at_once: turn_rate.is_none() && spec.lag_s == 0.0,
            has_odometry: spec.odometry.unwrap_or(!has_errors),
            errors: has_errors.then(|| DriveErrors::new(spec, radius_m, step_s)),
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
        let Motion {
            speed_m_s: after,
            turn_rate_rad_s,
        } = self.possible(setpoint, terrain);
        let followed = self.accelerate(speed_m_s, after, step_s);
        Driven {
            speed_m_s: followed.value,
            turn_rate_rad_s,
            length_m: followed.integral,
            turn_rad: turn_rate_rad_s * step_s,
        }
    }

    /// The same with errors, given the present motion of the body and the two setpoints in force.
    ///
    /// The setpoints are limited before they have their effect: a gain above 1 makes a robot faster than its limits.
    #[inline(never)]
    pub(crate) fn step_with_errors(
        &self,
        errors: &DriveErrors,
        now: Motion,
        setpoints: [Motion; 2],
        (terrain, step_s): (f64, f64),
    ) -> Driven {
        let setpoints = setpoints.map(|setpoint| self.possible(setpoint, terrain));
        let target = errors.gains.applied(errors.delay.mean(setpoints));
        let (speed, turn_rate) = if let Some(lag) = &errors.lag {
            let max_rate = self.max_acceleration_m_s2;
            (
                lag.follow(now.speed_m_s, target.speed_m_s, max_rate),
                lag.follow(now.turn_rate_rad_s, target.turn_rate_rad_s, f64::INFINITY),
            )
        } else {
            let turn_rate = Followed {
                value: target.turn_rate_rad_s,
                integral: target.turn_rate_rad_s * step_s,
            };
            let speed = self.accelerate(now.speed_m_s, target.speed_m_s, step_s);
            (speed, turn_rate)
        };
        Driven {
            speed_m_s: speed.value,
            turn_rate_rad_s: turn_rate.value,
            length_m: speed.integral,
            turn_rad: turn_rate.integral,
        }
    }

    /// The speed after a step at the maximum acceleration, and the distance.
    #[inline]
    fn accelerate(&self, speed_m_s: f64, after: f64, step_s: f64) -> Followed {
        let change = after - speed_m_s;
        let change_s = change.abs() / self.max_acceleration_m_s2;
        if change_s <= step_s {
            // While the speed changes, its mean is half way between both.
            return Followed {
                value: after,
                integral: after * step_s - change * change_s / 2.0,
            };
        }
        let after = speed_m_s + self.max_acceleration_m_s2.copysign(change) * step_s;
        Followed {
            value: after,
            integral: f64::midpoint(speed_m_s, after) * step_s,
        }
    }

    /// The nearest possible setpoint where `terrain` scales the maximum speeds.
    #[inline]
    fn possible(&self, setpoint: Motion, terrain: f64) -> Motion {
        let least = -self.max_reverse_speed_m_s * terrain;
        let most = self.max_speed_m_s * terrain;
        let max_turn = self.max_turn_rate_rad_s;
        Motion {
            speed_m_s: or_zero(setpoint.speed_m_s).max(least).min(most),
            turn_rate_rad_s: or_zero(setpoint.turn_rate_rad_s)
                .max(-max_turn)
                .min(max_turn),
        }
    }

    /// The nearest motion that a body can have where `terrain` scales the maximum speeds.
    pub(crate) fn executable(&self, motion: Motion, terrain: f64) -> Motion {
        if self.errors.is_none() {
            let speed_m_s = self.possible(motion, terrain).speed_m_s;
            return Motion {
                speed_m_s,
                ..motion
            };
        }
        let limits = [self.max_speed_m_s, self.max_reverse_speed_m_s];
        let [ahead, back] = limits.map(|speed_m_s| self.highest(speed_m_s * terrain));
        let turn_rad_s = ahead.turn_rate_rad_s.max(back.turn_rate_rad_s);
        Motion {
            speed_m_s: motion.speed_m_s.max(-back.speed_m_s).min(ahead.speed_m_s),
            turn_rate_rad_s: motion.turn_rate_rad_s.max(-turn_rad_s).min(turn_rad_s),
        }
    }

    /// The highest speed that results from setpoints up to this one, where the terrain has no effect.
    pub(crate) fn executed_m_s(&self, speed_m_s: f64) -> f64 {
        self.highest(speed_m_s).speed_m_s
    }

    /// The highest speed of the body, forward or in reverse, where the terrain has no effect.
    pub(crate) fn fastest_m_s(&self) -> f64 {
        self.fastest().speed_m_s
    }

    /// The highest turn rate of the body, in either direction, where the terrain has no effect.
    pub(crate) fn fastest_turn_rad_s(&self) -> f64 {
        self.fastest().turn_rate_rad_s
    }

    fn fastest(&self) -> Motion {
        self.highest(self.max_speed_m_s.max(self.max_reverse_speed_m_s))
    }

    /// The highest speed and turn rate that result from speed setpoints up to this one, and any turn rate.
    fn highest(&self, speed_m_s: f64) -> Motion {
        let max = Motion {
            speed_m_s,
            turn_rate_rad_s: self.max_turn_rate_rad_s,
        };
        self.errors.map_or(max, |errors| errors.gains.max(max))
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
    /// Anticlockwise.
    pub(crate) turn_rad: f64,
}

impl Driven {
    /// Speed and turn rate at the end of the step.
    #[inline]
    pub(crate) fn motion(&self) -> Motion {
        Motion {
            speed_m_s: self.speed_m_s,
            turn_rate_rad_s: self.turn_rate_rad_s,
        }
    }
}

fn is_one(gain: f64) -> bool {
    gain.total_cmp(&1.0).is_eq()
}

fn one() -> f64 {
    1.0
}

fn or_zero(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}

#[cfg(test)]
mod tests;
