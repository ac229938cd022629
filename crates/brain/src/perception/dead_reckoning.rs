//! Dead reckoning: the motion of the body since the previous step, from commands, wheels and
//! compass.

use crate::io::body::{Body, RangeRing};
use crate::io::command::Motion;
use crate::io::percept::{Percept, Reading};
use crate::perception::turns::{Headings, Turns};
use alloc::boxed::Box;
use base::trig::wrapped;
use core::f64::consts::TAU;

/// Maximum age of a reading that is used, in seconds.
const MAX_AGE_S: f64 = 1.0;

/// Wheel odometry above this multiple of the body's own limit is discarded as invalid. The fastest
/// terrain makes a body ten times as fast.
const MAX_WHEEL_FACTOR: f64 = 10.0;

/// Compass readings above this absolute value are discarded as invalid.
const MAX_HEADING_RAD: f64 = 1e4;

/// What dead reckoning knows of the body in one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Odometry {
    /// Time since the previous step.
    pub(crate) elapsed_s: f64,
    /// Current speed; negative in reverse.
    pub(crate) speed_m_s: f64,
    /// Angle by which the body has turned since the previous step.
    pub(crate) turned_rad: f64,
    /// Whether the motion is that of the commands: the robot has not measured it.
    pub(crate) is_commanded: bool,
}

/// Longer times between two percepts count as this time, in seconds: a day.
const MAX_ELAPSED_S: f64 = 86_400.0;

/// Estimate of the body's motion from its commands, wheel odometry and compass.
///
/// Mostly single precision: a world can hold a million brains.
#[derive(Debug, Clone)]
pub(crate) struct DeadReckoning {
    /// Time of the last percept; minus infinity while no percept had a time.
    time_s: f64,
    /// Speed of the command in force.
    setpoint_m_s: f64,
    /// Turn rate of the most recent turn.
    turn_rate_rad_s: f64,
    /// Speed that the body has reached if it follows its commands.
    speed_m_s: f32,
    /// Time since the end of that turn; 0 while the command in force is a turn.
    straight_s: f32,
    /// Compass heading in the previous step, or dead reckoning since the last one; NaN without any.
    heading_rad: f32,
    /// Index of the behaviour that decided the command in force, if there is a single one.
    pub(crate) decided_by: Option<u16>,
    /// Its turns, if a range scan can be older than a step.
    turns: Option<Box<Turns>>,
}

impl Default for DeadReckoning {
    fn default() -> Self {
        Self {
            time_s: f64::NEG_INFINITY,
            setpoint_m_s: 0.0,
            turn_rate_rad_s: 0.0,
            speed_m_s: 0.0,
            straight_s: 0.0,
            heading_rad: f32::NAN,
            decided_by: None,
            turns: None,
        }
    }
}

impl DeadReckoning {
    /// The time since the previous step, for a percept at a time; `None` if that is not later. It
    /// is exactly a period if it differs from one by rounding only, and also at the first percept
    /// and without a time.
    #[inline]
    pub(crate) fn elapsed_s(&mut self, time_s: Option<f64>, period_s: f64) -> Option<f64> {
        let Some(now_s) = time_s else {
            self.time_s += period_s;
            return Some(period_s);
        };
        if !self.is_later(time_s) {
            return None;
        }
        let elapsed_s = now_s - core::mem::replace(&mut self.time_s, now_s);
        let rounding_s = 1e-9 * period_s + 1e-15 * now_s.abs();
        let is_period = elapsed_s == f64::INFINITY || (elapsed_s - period_s).abs() <= rounding_s;
        Some(if is_period {
            period_s
        } else {
            elapsed_s.min(MAX_ELAPSED_S)
        })
    }

    /// Whether a percept at a time, or without one, is later than the last one.
    #[inline]
    pub(crate) fn is_later(&self, time_s: Option<f64>) -> bool {
        // False for NaN.
        time_s.is_none_or(|time_s| time_s > self.time_s && time_s < f64::INFINITY)
    }

    /// The command in force.
    pub(crate) fn command(&self) -> Motion {
        Motion {
            speed_m_s: self.setpoint_m_s,
            turn_rate_rad_s: self.commanded_rad_s(),
        }
    }

    fn commanded_rad_s(&self) -> f64 {
        if self.straight_s > 0.0 {
            0.0
        } else {
            self.turn_rate_rad_s
        }
    }

    /// Upper bound of the current speed, in m/s; negative in reverse. It is the larger of the
    /// commanded and the measured speed, because braking too early is safe. For localisation, see
    /// [`DeadReckoning::likely`].
    #[inline]
    fn current_speed_m_s(&self, percept: &Percept, body: &Body) -> f64 {
        let commanded = f64::from(self.speed_m_s);
        let max = body.max_speed_m_s;
        match wheels_m_s(percept, body) {
            Some(wheels) if wheels.abs() > commanded.abs() => wheels.max(-max).min(max),
            _ => commanded,
        }
    }

    /// The motion of the next time if the command in force is executed.
    pub(crate) fn ahead(&self, elapsed_s: f64, body: &Body) -> Odometry {
        let mut then = self.clone();
        then.advance(body, elapsed_s);
        Odometry {
            elapsed_s,
            speed_m_s: f64::from(then.speed_m_s),
            turned_rad: single(self.commanded_rad_s()) * elapsed_s,
            is_commanded: true,
        }
    }

    /// The motion since the previous step for localisation, in which the body has turned by an angle
    /// according to [`DeadReckoning::update`]: the measured speed if there is one, since terrain can
    /// slow the body down, and otherwise the commanded speed.
    ///
    /// The turn is that of wheels or command if the compass is noisy, and that of the command if wheels
    /// measure nothing: a filter that corrects the heading with the compass must not predict it with
    /// the same readings.
    #[inline]
    pub(crate) fn likely(&self, percept: &Percept, body: &Body, moved: &Odometry) -> Odometry {
        let turned_rad = if moved.is_commanded || body.heading_noise_rad > 0.0 {
            self.turn_rate_rad_s(percept, body) * moved.elapsed_s
        } else {
            moved.turned_rad
        };
        Odometry {
            elapsed_s: moved.elapsed_s,
            speed_m_s: wheels_m_s(percept, body).unwrap_or(f64::from(self.speed_m_s)),
            turned_rad,
            is_commanded: moved.is_commanded,
        }
    }

    /// Headings of the body within the last `age_s`, by its commands.
    #[inline]
    pub(crate) fn headings_within(&self, age_s: f64, body: &Body) -> Headings {
        let turning_s = age_s - f64::from(self.straight_s);
        if turning_s <= 0.0 {
            return Headings::default();
        }
        match &self.turns {
            // The scan is of the last step.
            None => Headings::turn(single(self.turn_rate_rad_s) * turning_s),
            Some(turns) => turns
                .within(age_s)
                .unwrap_or_else(|| Headings::within(body.max_turn_rate_rad_s * age_s)),
        }
    }

    /// Updates the estimate with a percept. Returns the motion since the previous step, by commands,
    /// wheels and compass.
    #[inline]
    pub(crate) fn reckon(&mut self, percept: &Percept, body: &Body, elapsed_s: f64) -> Odometry {
        let turned_rad = self.update(percept, body, elapsed_s);
        Odometry {
            elapsed_s,
            speed_m_s: self.current_speed_m_s(percept, body),
            turned_rad,
            is_commanded: wheels_m_s(percept, body).is_none(),
        }
    }

    /// Updates the estimate with a percept, `elapsed_s` after the previous one. Returns the angle by
    /// which the body has turned since then: from the compass if there is one, else from the wheels,
    /// else from the command.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "single precision is enough"
    )]
    fn update(&mut self, percept: &Percept, body: &Body, elapsed_s: f64) -> f64 {
        self.remember_turn(percept, body, elapsed_s);
        self.advance(body, elapsed_s);
        if percept.touch.is_some_and(|touch| touch.value) {
            // A collision has stopped the body, whatever its command.
            self.speed_m_s = 0.0;
        }
        let rate = self.turn_rate_rad_s(percept, body);
        let heading = percept.heading_rad;
        let heading = heading.filter(|reading| reading.value.abs() <= MAX_HEADING_RAD);
        // An older reading would need the turn rates of earlier steps.
        let is_of_step = |age_s: f64| (0.0..=1.000_001 * elapsed_s).contains(&age_s);
        let heading = heading.filter(|reading| is_of_step(reading.age_s));
        let measured = heading.map(|reading| wrapped(reading.value + rate * reading.age_s));
        let before_rad = f64::from(self.heading_rad);
        let now_rad = measured.unwrap_or_else(|| wrapped(before_rad + rate * elapsed_s));
        self.heading_rad = now_rad as f32;
        if before_rad.is_nan() || measured.is_none() {
            return rate * elapsed_s;
        }
        let turned_rad = wrapped(f64::from(self.heading_rad) - before_rad);
        if elapsed_s > body.period_s {
            // In a gap between percepts the body may have turned around more than once.
            turned_rad + TAU * libm::round((rate * elapsed_s - turned_rad) / TAU)
        } else {
            turned_rad
        }
    }

    /// Adds the turn since the previous step to the remembered ones, if scans can be older than that.
    #[inline]
    fn remember_turn(&mut self, percept: &Percept, body: &Body, elapsed_s: f64) {
        let rate_rad_s = single(self.commanded_rad_s());
        if self.turns.is_none() {
            self.turns = first_turns(percept, body, elapsed_s);
        }
        if let Some(turns) = &mut self.turns {
            turns.add(elapsed_s, rate_rad_s);
        }
    }

    /// Takes the command in force as executed for the elapsed time.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "single precision is enough"
    )]
    fn advance(&mut self, body: &Body, elapsed_s: f64) {
        let max_change = (body.max_acceleration_m_s2 * elapsed_s) as f32;
        let change = self.setpoint_m_s as f32 - self.speed_m_s;
        self.speed_m_s += change.max(-max_change).min(max_change);
        if self.straight_s > 0.0 {
            self.straight_s += elapsed_s as f32;
        }
    }

    fn turn_rate_rad_s(&self, percept: &Percept, body: &Body) -> f64 {
        let wheels = percept.motion.filter(is_current);
        let wheels = wheels.map(|motion| motion.value.turn_rate_rad_s);
        let wheels = wheels.filter(|rate| is_plausible(*rate, body.max_turn_rate_rad_s));
        wheels.unwrap_or(single(self.commanded_rad_s()))
    }

    /// Records the motion commanded until the next step.
    #[inline]
    pub(crate) fn record_command(&mut self, motion: Motion) {
        self.setpoint_m_s = motion.speed_m_s;
        if motion.turn_rate_rad_s == 0.0 {
            // The time itself is added in the next step, when it is known.
            self.straight_s = self.straight_s.max(f32::MIN_POSITIVE);
        } else {
            self.turn_rate_rad_s = motion.turn_rate_rad_s;
            self.straight_s = 0.0;
        }
    }
}

/// The turns to remember from now on; `None` if all scans are of the last step.
#[inline]
fn first_turns(percept: &Percept, body: &Body, elapsed_s: f64) -> Option<Box<Turns>> {
    let max_s = body.period_s * (1.0 + 1e-9);
    // A scan is replaced one step before it would be a period old.
    let max_age_s = |ring: &RangeRing| ring.latency_s + ring.period_s - body.period_s;
    if body.rings.iter().any(|ring| max_age_s(ring) > max_s) {
        return Some(Box::new(Turns::at_rest()));
    }
    let mut ages_s = percept.scans.iter().filter_map(|scan| scan.age_s);
    // A scan was lost. Earlier turns are unknown.
    ages_s.any(|age_s| age_s > elapsed_s).then(Box::default)
}

/// A number in single precision.
#[expect(clippy::cast_possible_truncation, reason = "as stated")]
fn single(value: f64) -> f64 {
    f64::from(value as f32)
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
            sum += odometry.update(percept, &body, 0.1);
            odometry.record_command(TURN);
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
    fn a_late_compass_does_not_measure_the_turn_of_this_step() {
        // At rest until now, by a compass that is 1 s late.
        let late = Percept {
            heading_rad: Some(Reading {
                value: 0.5,
                age_s: 1.0,
            }),
            ..Percept::default()
        };
        let (mut odometry, body) = (DeadReckoning::default(), rover());
        odometry.update(&late, &body, 0.1);
        odometry.record_command(TURN);
        let turned_rad = odometry.update(&late, &body, 0.1);
        assert!((turned_rad - 0.1).abs() < 1e-6, "{turned_rad}");
    }

    #[test]
    fn a_compass_that_is_slower_than_the_brain_corrects_the_turn() {
        // The robot turns at half the commanded rate; a measurement every five steps.
        let percepts: Vec<Percept> = (0..11)
            .map(|step| {
                let age_s = 0.1 * f64::from(step % 5);
                let value = 0.05 * f64::from(step - step % 5);
                let heading_rad = Some(Reading { value, age_s });
                Percept {
                    heading_rad,
                    ..Percept::default()
                }
            })
            .collect();
        assert!((turned_rad(&percepts) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn in_a_gap_between_percepts_more_than_a_full_turn_is_known_from_the_command() {
        let (mut odometry, body) = (DeadReckoning::default(), rover());
        let compass = |heading_rad: f64| Percept {
            heading_rad: Some(now(wrapped(heading_rad))),
            ..Percept::default()
        };
        odometry.update(&compass(1.0), &body, 0.1);
        odometry.record_command(TURN);
        // A little less than commanded.
        let turned_rad = odometry.update(&compass(1.0 + 9.9), &body, 10.0);
        assert!((turned_rad - 9.9).abs() < 1e-5, "{turned_rad}");
    }

    #[test]
    fn the_elapsed_time_is_a_period_exactly_if_it_differs_by_rounding_only() {
        let period_s = 0.1;
        for start_s in [0.0, 1e3, 1.7e9] {
            let mut odometry = DeadReckoning::default();
            assert_eq!(odometry.elapsed_s(Some(start_s), period_s), Some(period_s));
            for step in 1..100 {
                let time_s = start_s + f64::from(step) * period_s;
                let elapsed_s = odometry.elapsed_s(Some(time_s), period_s);
                assert_eq!(elapsed_s, Some(period_s), "{start_s} {step}");
            }
            let time_s = start_s + 100.0 * period_s;
            let elapsed_s = odometry.elapsed_s(Some(time_s + 1e-3), period_s).unwrap();
            assert!((elapsed_s - 0.101).abs() < 1e-6, "{elapsed_s}");
        }
    }

    #[test]
    fn the_time_of_the_most_recent_turn_is_remembered() {
        let (mut odometry, body) = (DeadReckoning::default(), rover());
        odometry.record_command(TURN);
        let within = |odometry: &DeadReckoning, age_s| {
            let [low_rad, high_rad] = odometry.headings_within(age_s, &rover()).now_rad;
            assert!((low_rad - high_rad).abs() < 1e-12);
            low_rad
        };
        assert!((within(&odometry, 0.3) - 0.3).abs() < 1e-6);
        odometry.record_command(Motion::default());
        odometry.update(&Percept::default(), &body, 0.2);
        assert!((within(&odometry, 0.3) - 0.1).abs() < 1e-6);
        assert!(within(&odometry, 0.1).abs() < 1e-6);
    }
}
