//! Localisation: the filter that estimates the pose of the robot.

use super::displacement::Displacement;
use super::pose::Pose;
use super::readings::fresh;
use super::validation_gate::{Innovation, ValidationGate, Verdict};
use crate::io::body::Body;
use crate::io::percept::{Percept, Reading};
use crate::perception::sector::direction;
use base::geometry::Point;
use base::trig::wrapped;

/// Relative odometry error, of the distance and of the turn.
const ODOMETRY_ERROR: f64 = 0.02;

/// Minimum process noise, also at rest: about a millimetre and some hundredths of a degree per
/// second. It keeps the gain above zero, so that a robot that has been at rest for long still
/// follows its sensors.
const PROCESS_NOISE_M2_S: f64 = 1e-6;
const PROCESS_NOISE_RAD2_S: f64 = 1e-8;

/// Readings farther from the origin than this are ignored.
const MAX_COORDINATE_M: f64 = 1e7;

/// The state of the pose filter; position and heading with their variances.
#[derive(Debug, Clone, Default)]
pub(crate) struct Localisation {
    at: Option<(Point, f64)>,
    heading: Option<(f64, f64)>,
    /// Covariance of position and heading: a heading error leads to a lateral position error.
    covariance: Point,
    position_gate: ValidationGate<Point>,
    heading_gate: ValidationGate<f64>,
    /// Ages of the last readings.
    position_s: Option<f64>,
    heading_s: Option<f64>,
    age_s: f64,
}

impl Localisation {
    /// The pose, once a position and a heading are known.
    pub(crate) fn pose(&self) -> Option<Pose> {
        let ((at, at_variance), (heading_rad, variance)) = (self.at?, self.heading?);
        Some(Pose {
            at,
            heading_rad,
            deviation_m: libm::sqrt(at_variance),
            deviation_rad: libm::sqrt(variance),
            age_s: self.age_s,
        })
    }

    /// Updates the pose after a step with a displacement.
    pub(crate) fn update(&mut self, percept: &Percept, body: &Body, moved: &Displacement) {
        self.predict(moved);
        self.age_s += moved.elapsed_s;
        if let Some(heading) = fresh(percept.heading_rad, &mut self.heading_s, moved.elapsed_s) {
            self.update_heading(&heading, body, moved.turn_rate_rad_s());
        }
        if let Some(position) = fresh(percept.position, &mut self.position_s, moved.elapsed_s) {
            self.update_position(&position, body, moved.speed_m_s);
        }
    }

    /// Corrects the heading with a reading that was measured while the body turned at `rate_rad_s`.
    fn update_heading(&mut self, heading: &Reading<f64>, body: &Body, rate_rad_s: f64) {
        let since_rad = rate_rad_s * heading.age_s;
        // The body may have turned in the other direction.
        let tolerance_rad = since_rad.abs() + body.max_turn_rate_rad_s * heading.age_s;
        self.correct_heading(
            heading.value + since_rad,
            body.heading_noise_rad,
            tolerance_rad,
        );
    }

    /// Corrects the position with a reading that was measured while the body moved at `speed_m_s`.
    fn update_position(&mut self, position: &Reading<Point>, body: &Body, speed_m_s: f64) {
        let since_m = speed_m_s * position.age_s;
        let heading_rad = self.heading.map_or(0.0, |(heading_rad, _)| heading_rad);
        let measured = position.value.plus(direction(heading_rad).times(since_m));
        // The body may have moved in the other direction.
        let tolerance_m = since_m.abs() + body.max_speed_m_s * position.age_s;
        if self.correct_position(measured, body.position_noise_m, tolerance_m) {
            self.age_s = position.age_s;
        }
    }

    fn predict(&mut self, moved: &Displacement) {
        let Displacement {
            elapsed_s,
            path_m,
            chord_m,
            bearing_rad,
            turned_rad,
            ..
        } = *moved;
        if let (Some((at, variance)), Some((heading_rad, heading_variance))) =
            (&mut self.at, self.heading)
        {
            let motion = direction(heading_rad + bearing_rad).times(chord_m);
            *at = at.plus(motion);
            *variance += (ODOMETRY_ERROR * path_m) * (ODOMETRY_ERROR * path_m)
                + PROCESS_NOISE_M2_S * elapsed_s;
            // P' = F P F^T with d(at)/d(heading) = the displacement turned left; the mean of both
            // axes.
            *variance += motion.cross(self.covariance) + chord_m * chord_m * heading_variance / 2.0;
            *variance = variance.max(0.0);
            let left = Point {
                x: -motion.y,
                y: motion.x,
            };
            self.covariance = self.covariance.plus(left.times(heading_variance));
            self.position_gate.predict(|at| at.plus(motion));
        }
        if let Some((heading_rad, variance)) = &mut self.heading {
            *heading_rad = wrapped(*heading_rad + turned_rad);
            *variance += (ODOMETRY_ERROR * turned_rad) * (ODOMETRY_ERROR * turned_rad)
                + PROCESS_NOISE_RAD2_S * elapsed_s;
            self.heading_gate.predict(|heading| heading + turned_rad);
        }
    }

    fn correct_heading(&mut self, measured_rad: f64, noise_rad: f64, tolerance_rad: f64) {
        if !measured_rad.is_finite() || measured_rad.abs() > 1e4 {
            return;
        }
        let sensor = noise_rad * noise_rad;
        let (before_rad, own) = self.heading.unwrap_or((measured_rad, f64::INFINITY));
        let difference_rad = wrapped(measured_rad - before_rad);
        let innovation = Innovation {
            distance: difference_rad.abs(),
            variances: [own, sensor],
            tolerance: tolerance_rad,
        };
        let distance_rad = |last: &f64| wrapped(measured_rad - last).abs();
        let verdict = self
            .heading_gate
            .check(measured_rad, &innovation, distance_rad);
        if let Some(own) = prior_variance(verdict, own) {
            let gain = gain(own, sensor);
            let heading_rad = wrapped(before_rad + gain * difference_rad);
            self.heading = Some((heading_rad, posterior_variance(own, sensor)));
            self.covariance = self.covariance.times(1.0 - gain);
        }
    }

    /// Returns whether the reading was used.
    fn correct_position(&mut self, measured: Point, noise_m: f64, tolerance_m: f64) -> bool {
        // False for NaN.
        let is_valid = measured.x.abs() <= MAX_COORDINATE_M && measured.y.abs() <= MAX_COORDINATE_M;
        if !is_valid {
            return false;
        }
        let sensor = noise_m * noise_m;
        // Without a heading, the position was not predicted.
        let predicted = self.at.filter(|_| self.heading.is_some());
        let (before, own) = predicted.unwrap_or((measured, f64::INFINITY));
        let innovation = Innovation {
            distance: before.to(measured).length(),
            variances: [own, sensor],
            tolerance: tolerance_m,
        };
        let distance_m = |last: &Point| last.to(measured).length();
        let verdict = self.position_gate.check(measured, &innovation, distance_m);
        if let Some(own) = prior_variance(verdict, own) {
            let gain = gain(own, sensor);
            let at = before.plus(before.to(measured).times(gain));
            self.at = Some((at, posterior_variance(own, sensor)));
            self.covariance = self.covariance.times(1.0 - gain);
        }
        verdict != Verdict::Reject
    }
}

/// The variance of the estimate before the correction; `None` if the reading is ignored.
fn prior_variance(verdict: Verdict, own: f64) -> Option<f64> {
    match verdict {
        Verdict::Accept => Some(own),
        Verdict::Reset => Some(f64::INFINITY),
        Verdict::Reject => None,
    }
}

/// The Kalman gain, 0 to 1.
fn gain(own: f64, sensor: f64) -> f64 {
    if own.is_infinite() || sensor == 0.0 {
        1.0
    } else {
        own / (own + sensor)
    }
}

/// The variance after a correction.
fn posterior_variance(own: f64, sensor: f64) -> f64 {
    if own.is_infinite() {
        sensor
    } else {
        own * (1.0 - gain(own, sensor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_of_walls::{now, rover};

    const AT_REST: Displacement = Displacement {
        elapsed_s: 0.1,
        path_m: 0.0,
        chord_m: 0.0,
        bearing_rad: 0.0,
        turned_rad: 0.0,
        speed_m_s: 0.0,
    };
    const AHEAD: Displacement = Displacement {
        path_m: 0.1,
        chord_m: 0.1,
        speed_m_s: 1.0,
        ..AT_REST
    };

    fn percept(x: f64, y: f64, heading_rad: f64) -> Percept {
        Percept {
            position: Some(now(Point { x, y })),
            heading_rad: Some(now(heading_rad)),
            ..Percept::default()
        }
    }

    #[test]
    fn the_pose_is_unknown_without_a_position_or_without_a_heading() {
        let mut localisation = Localisation::default();
        let only_position = Percept {
            heading_rad: None,
            ..percept(1.0, 2.0, 0.0)
        };
        localisation.update(&only_position, &rover(), &AT_REST);
        assert_eq!(localisation.pose(), None);
        localisation.update(&percept(1.0, 2.0, 0.0), &rover(), &AT_REST);
        assert_eq!(localisation.pose().unwrap().at, Point { x: 1.0, y: 2.0 });
    }

    #[test]
    fn odometry_predicts_the_pose_with_growing_deviation() {
        let mut localisation = Localisation::default();
        localisation.update(&percept(0.0, 0.0, 0.0), &rover(), &AT_REST);
        let mut before_m = 0.0;
        for _ in 0..50 {
            localisation.update(&Percept::default(), &rover(), &AHEAD);
            let pose = localisation.pose().unwrap();
            assert!(pose.deviation_m > before_m);
            before_m = pose.deviation_m;
        }
        let pose = localisation.pose().unwrap();
        assert!((pose.at.x - 5.0).abs() < 1e-9 && (pose.age_s - 5.0).abs() < 1e-9);
    }

    #[test]
    fn many_noisy_readings_give_a_precise_position() {
        let mut body = rover();
        body.position_noise_m = 2.0;
        let mut localisation = Localisation::default();
        for step in 0..400 {
            let off = if step % 2 == 0 { 2.0 } else { -2.0 };
            localisation.update(&percept(off, -off, 0.0), &body, &AT_REST);
        }
        let pose = localisation.pose().unwrap();
        assert!(pose.at.length() < 0.05, "{pose:?}");
        assert!((pose.deviation_m - 0.1).abs() < 0.01, "{pose:?}");
    }

    #[test]
    fn a_repeated_reading_counts_once() {
        let mut body = rover();
        body.position_noise_m = 2.0;
        let mut localisation = Localisation::default();
        let mut repeated = percept(0.0, 0.0, 0.0);
        for step in 0..10 {
            repeated.position = Some(Reading {
                value: Point::default(),
                age_s: 0.2 + 0.1 * f64::from(step),
            });
            localisation.update(&repeated, &body, &AT_REST);
        }
        assert!((localisation.pose().unwrap().deviation_m - 2.0).abs() < 1e-4);
    }

    #[test]
    fn a_delayed_reading_is_compensated_by_the_distance_since() {
        let mut localisation = Localisation::default();
        localisation.update(&percept(0.0, 0.0, 0.0), &rover(), &AT_REST);
        let late = Percept {
            position: Some(Reading {
                value: Point { x: 4.0, y: 0.0 },
                age_s: 0.05,
            }),
            ..percept(0.0, 0.0, 0.0)
        };
        localisation.update(&late, &rover(), &AHEAD);
        assert!((localisation.pose().unwrap().at.x - 4.05).abs() < 1e-9);
    }

    #[test]
    fn invalid_readings_are_ignored() {
        let mut localisation = Localisation::default();
        localisation.update(&percept(1.0, 1.0, 1.0), &rover(), &AT_REST);
        let before = localisation.pose();
        for bad in [f64::NAN, f64::INFINITY, -1e300] {
            localisation.update(&percept(bad, 0.0, bad), &rover(), &AT_REST);
            assert_eq!(localisation.pose().unwrap().at, before.unwrap().at);
        }
    }
}
