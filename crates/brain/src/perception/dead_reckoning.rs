//! Dead reckoning: the motion of the body since the previous step, from commands, wheels and
//! compass.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::percept::{Percept, Reading};
use base::trig::wrapped;

/// Maximum age of a reading that is used, in seconds.
const MAX_AGE_S: f64 = 1.0;

/// Wheel odometry above this multiple of the body's own limit is discarded as invalid. The fastest
/// terrain makes a body ten times as fast.
const MAX_WHEEL_FACTOR: f64 = 10.0;

/// Compass readings above this absolute value are discarded as invalid.
const MAX_HEADING_RAD: f64 = 1e4;

/// Estimate of the body's motion from its commands, wheel odometry and compass.
///
/// Single precision: a world can hold a million brains.
#[derive(Debug, Clone, Default)]
pub(crate) struct DeadReckoning {
    /// Speed that the body has reached if it follows its commands.
    speed_m_s: f32,
    /// Turn rate of the most recent turn.
    turn_rate_rad_s: f32,
    /// Time since the end of that turn; 0 while it lasts.
    straight_s: f32,
    /// Compass heading in the previous step.
    heading_rad: Option<f32>,
}

impl DeadReckoning {
    /// Upper bound of the current speed, in m/s; negative in reverse. It is the larger of the
    /// commanded and the measured speed, because braking too early is safe. For localisation, see
    /// [`DeadReckoning::likely_speed_m_s`].
    #[inline]
    pub(crate) fn current_speed_m_s(&self, percept: &Percept, body: &Body) -> f64 {
        let commanded = f64::from(self.speed_m_s);
        let max = body.max_speed_m_s;
        match wheels_m_s(percept, body) {
            Some(wheels) if wheels.abs() > commanded.abs() => wheels.max(-max).min(max),
            _ => commanded,
        }
    }

    /// Most likely current speed, in m/s; negative in reverse. It is the measured speed if there is
    /// one, since terrain can slow the body down, and otherwise the commanded speed.
    #[inline]
    pub(crate) fn likely_speed_m_s(&self, percept: &Percept, body: &Body) -> f64 {
        wheels_m_s(percept, body).unwrap_or(f64::from(self.speed_m_s))
    }

    /// Angle by which the body has turned within the last `age_s`, by its commands.
    #[inline]
    pub(crate) fn turned_within_rad(&self, age_s: f64) -> f64 {
        let turning_s = (age_s - f64::from(self.straight_s)).max(0.0);
        f64::from(self.turn_rate_rad_s) * turning_s
    }

    /// Updates the estimate with a percept, at the start of a step. Returns the angle by which the
    /// body has turned since the previous step: from the compass if there is one, else from the
    /// wheels, else from the command.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "single precision is enough"
    )]
    pub(crate) fn update(&mut self, percept: &Percept, body: &Body) -> f64 {
        if percept.touch.is_some_and(|touch| touch.value) {
            // A collision has stopped the body, whatever its command.
            self.speed_m_s = 0.0;
        }
        let rate = self.turn_rate_rad_s(percept, body);
        let heading = percept.heading_rad.filter(is_current);
        let heading = heading.filter(|reading| reading.value.abs() <= MAX_HEADING_RAD);
        // Compensates the latency of the compass.
        let heading_now =
            heading.map(|reading| wrapped(reading.value + rate * reading.age_s) as f32);
        let before = core::mem::replace(&mut self.heading_rad, heading_now);
        match (before, heading_now) {
            (Some(before), Some(now)) => wrapped(f64::from(now) - f64::from(before)),
            _ => rate * body.period_s,
        }
    }

    /// The angle that [`DeadReckoning::update`] returned, or that of wheels or command if the
    /// compass is noisy: a filter that corrects the heading with the compass must not predict it
    /// with the same readings.
    pub(crate) fn turned_without_compass_rad(
        &self,
        turned_rad: f64,
        percept: &Percept,
        body: &Body,
    ) -> f64 {
        if body.heading_noise_rad > 0.0 {
            self.turn_rate_rad_s(percept, body) * body.period_s
        } else {
            turned_rad
        }
    }

    fn turn_rate_rad_s(&self, percept: &Percept, body: &Body) -> f64 {
        let commanded = if self.straight_s > 0.0 {
            0.0
        } else {
            f64::from(self.turn_rate_rad_s)
        };
        let wheels = percept.motion.filter(is_current);
        let wheels = wheels.map(|motion| motion.value.turn_rate_rad_s);
        let wheels = wheels.filter(|rate| is_plausible(*rate, body.max_turn_rate_rad_s));
        wheels.unwrap_or(commanded)
    }

    /// Records the motion commanded until the next step.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "single precision is enough"
    )]
    pub(crate) fn record_command(&mut self, motion: Motion, body: &Body) {
        let max_change = (body.max_acceleration_m_s2 * body.period_s) as f32;
        let change = motion.speed_m_s as f32 - self.speed_m_s;
        self.speed_m_s += change.max(-max_change).min(max_change);
        if motion.turn_rate_rad_s == 0.0 {
            self.straight_s += body.period_s as f32;
        } else {
            self.turn_rate_rad_s = motion.turn_rate_rad_s as f32;
            self.straight_s = 0.0;
        }
    }
}

/// Measured speed, if it is current and plausible.
#[inline]
fn wheels_m_s(percept: &Percept, body: &Body) -> Option<f64> {
    let wheels = percept.motion.filter(is_current)?.value.speed_m_s;
    let max = body.max_speed_m_s.max(body.max_reverse_speed_m_s);
    is_plausible(wheels, max).then_some(wheels)
}

fn is_plausible(wheels: f64, max: f64) -> bool {
    wheels.is_finite() && wheels.abs() <= MAX_WHEEL_FACTOR * max
}

fn is_current<T>(reading: &Reading<T>) -> bool {
    (0.0..=MAX_AGE_S).contains(&reading.age_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_of_walls::{now, rover};
    use crate::{BeliefsSpec, Brain, BrainSpec};
    use base::geometry::Point;
    use std::sync::Arc;

    const TURN: Motion = Motion {
        speed_m_s: 0.0,
        turn_rate_rad_s: 1.0,
    };

    fn turned_rad(percepts: &[Percept]) -> f64 {
        let (mut odometry, body) = (DeadReckoning::default(), rover());
        let mut sum = 0.0;
        for percept in percepts {
            sum += odometry.update(percept, &body);
            odometry.record_command(TURN, &body);
        }
        sum
    }

    #[test]
    fn without_compass_and_wheels_the_turn_is_the_commanded_one() {
        assert!((turned_rad(&vec![Percept::default(); 11]) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn wheels_take_precedence_over_commands_and_a_compass_over_wheels() {
        let value = Motion {
            turn_rate_rad_s: 0.5,
            ..TURN
        };
        let mut percept = Percept {
            motion: Some(Reading { value, age_s: 0.0 }),
            ..Percept::default()
        };
        let by_wheels = turned_rad(&vec![percept.clone(); 11]);
        assert!((by_wheels - 0.55).abs() < 1e-6, "{by_wheels}");
        let with_compass: Vec<Percept> = (0..11)
            .map(|step| {
                let value = wrapped(3.0 + 0.02 * f64::from(step));
                percept.heading_rad = Some(Reading { value, age_s: 0.0 });
                percept.clone()
            })
            .collect();
        // The first reading has no predecessor to compare with.
        assert!((turned_rad(&with_compass) - 0.25).abs() < 1e-6);
    }

    #[test]
    fn with_a_noisy_compass_the_heading_comes_from_the_compass_and_the_turn_from_wheels() {
        let mut body = rover();
        body.heading_noise_rad = 0.1;
        let spec = BrainSpec {
            beliefs: Some(BeliefsSpec::default()),
            ..BrainSpec::default()
        };
        let mut brain = Brain::new(Arc::new(spec), Arc::new(body));
        for step in 0..400 {
            let off_rad = if step % 2 == 0 { 0.1 } else { -0.1 };
            brain.step(&Percept {
                position: Some(now(Point::default())),
                heading_rad: Some(now(off_rad)),
                motion: Some(now(Motion::default())),
                ..Percept::default()
            });
        }
        let pose = brain
            .belief_state()
            .and_then(|belief_state| belief_state.pose)
            .unwrap();
        assert!(pose.heading_rad.abs() < 0.01, "{pose:?}");
        assert!((pose.deviation_rad - 0.005).abs() < 0.001, "{pose:?}");
    }

    #[test]
    fn the_latency_of_a_compass_is_compensated() {
        let percepts: Vec<Percept> = (0..11)
            .map(|step| {
                // One measurement every five steps.
                let age_s = 0.1 * f64::from(step % 5);
                let value = 0.1 * f64::from(step) - age_s;
                let heading_rad = Some(Reading { value, age_s });
                Percept {
                    heading_rad,
                    ..Percept::default()
                }
            })
            .collect();
        assert!((turned_rad(&percepts) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_time_of_the_most_recent_turn_is_remembered() {
        let (mut odometry, body) = (DeadReckoning::default(), rover());
        odometry.record_command(TURN, &body);
        assert!((odometry.turned_within_rad(0.3) - 0.3).abs() < 1e-6);
        odometry.record_command(Motion::default(), &body);
        odometry.record_command(Motion::default(), &body);
        assert!((odometry.turned_within_rad(0.3) - 0.1).abs() < 1e-6);
        assert!(odometry.turned_within_rad(0.1).abs() < 1e-6);
    }
}
