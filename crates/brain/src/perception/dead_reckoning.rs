//! How the body has moved since the brain last looked, as far as the brain can tell.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::percept::{Percept, Reading};
use base::trig::wrapped;

/// Readings older than this say nothing of now.
const OLDEST_S: f64 = 1.0;

/// Wheels that say more than so many times what the body can do are broken; the fastest ground there is
/// makes it ten times as fast.
const MOST_TIMES: f64 = 10.0;

/// A compass that says more than this many radians is broken.
const MAX_HEADING_RAD: f64 = 1e4;

/// Dead reckoning from commands, and what wheels and compass say.
///
/// A world can hold a million brains, so these are short numbers.
#[derive(Debug, Clone, Default)]
pub(crate) struct DeadReckoning {
    /// What the body has come to if it does what it is told.
    speed_m_s: f32,
    /// Of the last turn.
    turn_rate_rad_s: f32,
    /// Time since that turn ended; 0 while it lasts.
    straight_s: f32,
    /// The compass's course when the brain last looked.
    course_rad: Option<f32>,
}

impl DeadReckoning {
    /// At most so fast it now goes, in m/s; negative if backwards. What it was told, or what the
    /// wheels say if that is more: who brakes too early is safe. To reckon where it is, see
    /// [`DeadReckoning::gone_m_s`].
    #[inline]
    pub(crate) fn now_m_s(&self, percept: &Percept, body: &Body) -> f64 {
        let told = f64::from(self.speed_m_s);
        let most = body.max_speed_m_s;
        match wheels_m_s(percept, body) {
            Some(wheels) if wheels.abs() > told.abs() => wheels.max(-most).min(most),
            _ => told,
        }
    }

    /// So fast it goes in all likelihood, in m/s; negative if backwards. What the wheels say, if they
    /// do: sand slows who is told to go fast. Else what it was told.
    #[inline]
    pub(crate) fn gone_m_s(&self, percept: &Percept, body: &Body) -> f64 {
        wheels_m_s(percept, body).unwrap_or(f64::from(self.speed_m_s))
    }

    /// Angle by which it has turned within the last `age_s`.
    #[inline]
    pub(crate) fn turned_within_rad(&self, age_s: f64) -> f64 {
        let turning_s = (age_s - f64::from(self.straight_s)).max(0.0);
        f64::from(self.turn_rate_rad_s) * turning_s
    }

    /// Takes in what the percept says of the body's motion, at the beginning of a step. Returns the
    /// angle by which it has turned since the last one: from the compass if there is one, else from
    /// the wheels, else as it was told.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(crate) fn take_in(&mut self, percept: &Percept, body: &Body) -> f64 {
        if percept.touch.is_some_and(|touch| touch.value) {
            // What it ran into has stopped it, whatever it was told.
            self.speed_m_s = 0.0;
        }
        let rate = self.turn_rate_rad_s(percept, body);
        let heading = percept.heading_rad.filter(is_of_now);
        let heading = heading.filter(|reading| reading.value.abs() <= MAX_HEADING_RAD);
        // The compass may lag.
        let course = heading.map(|reading| wrapped(reading.value + rate * reading.age_s) as f32);
        let before = core::mem::replace(&mut self.course_rad, course);
        match (before, course) {
            (Some(before), Some(now)) => wrapped(f64::from(now) - f64::from(before)),
            _ => rate * body.period_s,
        }
    }

    /// As [`DeadReckoning::take_in`] said, but from the wheels or as it was told if the compass errs: whoever
    /// corrects the course by the compass must not have carried it on by the same compass.
    pub(crate) fn turned_beside_compass_rad(
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
        let told = if self.straight_s > 0.0 {
            0.0
        } else {
            f64::from(self.turn_rate_rad_s)
        };
        let wheels = percept.motion.filter(is_of_now);
        let wheels = wheels.map(|motion| motion.value.turn_rate_rad_s);
        let wheels = wheels.filter(|rate| can_be(*rate, body.max_turn_rate_rad_s));
        wheels.unwrap_or(told)
    }

    /// Notes what the body was told to do until the next step.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(crate) fn told(&mut self, motion: Motion, body: &Body) {
        let most = (body.max_acceleration_m_s2 * body.period_s) as f32;
        let change = motion.speed_m_s as f32 - self.speed_m_s;
        self.speed_m_s += change.max(-most).min(most);
        if motion.turn_rate_rad_s == 0.0 {
            self.straight_s += body.period_s as f32;
        } else {
            self.turn_rate_rad_s = motion.turn_rate_rad_s as f32;
            self.straight_s = 0.0;
        }
    }
}

/// What wheels say, if they say it of now and can be right.
#[inline]
fn wheels_m_s(percept: &Percept, body: &Body) -> Option<f64> {
    let wheels = percept.motion.filter(is_of_now)?.value.speed_m_s;
    let most = body.max_speed_m_s.max(body.max_reverse_speed_m_s);
    can_be(wheels, most).then_some(wheels)
}

fn can_be(wheels: f64, most: f64) -> bool {
    wheels.is_finite() && wheels.abs() <= MOST_TIMES * most
}

fn is_of_now<T>(reading: &Reading<T>) -> bool {
    (0.0..=OLDEST_S).contains(&reading.age_s)
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
        let (mut reckoning, body) = (DeadReckoning::default(), rover());
        let mut sum = 0.0;
        for percept in percepts {
            sum += reckoning.take_in(percept, &body);
            reckoning.told(TURN, &body);
        }
        sum
    }

    #[test]
    fn without_compass_and_wheels_it_has_turned_as_it_was_told() {
        assert!((turned_rad(&vec![Percept::default(); 11]) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn wheels_know_better_than_commands_and_a_compass_better_than_wheels() {
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
        // At its first look it has nothing to compare with.
        assert!((turned_rad(&with_compass) - 0.25).abs() < 1e-6);
    }

    #[test]
    fn a_compass_that_errs_says_where_it_points_and_wheels_how_far_it_has_turned() {
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
    fn a_compass_that_lags_is_carried_on() {
        let percepts: Vec<Percept> = (0..11)
            .map(|step| {
                // One look in five steps.
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
    fn it_remembers_when_it_last_turned() {
        let (mut reckoning, body) = (DeadReckoning::default(), rover());
        reckoning.told(TURN, &body);
        assert!((reckoning.turned_within_rad(0.3) - 0.3).abs() < 1e-6);
        reckoning.told(Motion::default(), &body);
        reckoning.told(Motion::default(), &body);
        assert!((reckoning.turned_within_rad(0.3) - 0.1).abs() < 1e-6);
        assert!(reckoning.turned_within_rad(0.1).abs() < 1e-6);
    }
}
