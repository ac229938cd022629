//! The filter that estimates the pose of the robot at one moment.

use super::displacement::Displacement;
use super::pose::{Pose, turned};
use super::validation_gate::{Innovation, ValidationGate, Verdict};
use crate::perception::sector::direction;
use base::geometry::Point;
use base::trig::wrapped;

/// The state of the filter: position and heading with their variances.
#[derive(Debug, Clone, Copy)]
pub(super) struct PoseFilter {
    at: Point,
    heading_rad: f64,
    /// Infinite while unknown.
    variance_m2: f64,
    variance_rad2: f64,
    /// Covariance of position and heading: a heading error leads to a lateral position error.
    covariance: Point,
    position_gate: ValidationGate<Point>,
    heading_gate: ValidationGate<f64>,
    /// Time since the last position reading.
    age_s: f64,
}

base::hashed!(PoseFilter {
    at,
    heading_rad,
    variance_m2,
    variance_rad2,
    covariance,
    position_gate,
    heading_gate,
    age_s
});

impl Default for PoseFilter {
    fn default() -> Self {
        Self {
            at: Point::default(),
            heading_rad: 0.0,
            variance_m2: f64::INFINITY,
            variance_rad2: f64::INFINITY,
            covariance: Point::default(),
            position_gate: ValidationGate::default(),
            heading_gate: ValidationGate::default(),
            age_s: 0.0,
        }
    }
}

impl PoseFilter {
    /// The pose, once a position and a heading are known.
    pub(super) fn pose(&self) -> Option<Pose> {
        let is_known = self.variance_m2.is_finite() && self.variance_rad2.is_finite();
        is_known.then(|| Pose {
            at: self.at,
            heading_rad: self.heading_rad,
            deviation_m: libm::sqrt(self.variance_m2),
            deviation_rad: libm::sqrt(self.variance_rad2),
            age_s: self.age_s,
        })
    }

    /// Predicts the pose after a displacement.
    pub(super) fn predict(&mut self, moved: &Displacement) {
        self.age_s += moved.elapsed_s;
        if self.variance_rad2.is_finite() {
            self.move_by(turned(moved.chord, direction(self.heading_rad)));
            self.variance_m2 += moved.variance_m2;
            self.heading_rad = wrapped(self.heading_rad + moved.turned_rad);
            self.variance_rad2 += moved.variance_rad2;
            self.heading_gate
                .predict(|heading_rad| heading_rad + moved.turned_rad);
        } else if moved.chord != Point::default() {
            // The direction of the motion is unknown.
            self.variance_m2 = f64::INFINITY;
        }
        self.forget_overflow();
    }

    /// Forgets a pose that is not finite, such as that of a body of absurd speed: no reading could
    /// correct it.
    fn forget_overflow(&mut self) {
        let is_finite = (self.at.x + self.at.y + self.heading_rad).is_finite();
        let has_variances = !(self.variance_m2.is_nan() || self.variance_rad2.is_nan());
        if !(is_finite && has_variances) {
            *self = Self::default();
        }
    }

    fn move_by(&mut self, motion: Point) {
        self.at = self.at.plus(motion);
        // P' = F P F^T with d(at)/d(heading) = the displacement turned left; the mean of both axes.
        self.variance_m2 +=
            motion.cross(self.covariance) + motion.length_squared() * self.variance_rad2 / 2.0;
        self.variance_m2 = self.variance_m2.max(0.0);
        let left = Point {
            x: -motion.y,
            y: motion.x,
        };
        self.covariance = self.covariance.plus(left.times(self.variance_rad2));
        self.position_gate.predict(|at| at.plus(motion));
    }

    /// Corrects the heading with a reading of a sensor of this noise.
    pub(super) fn correct_heading(&mut self, measured_rad: f64, noise_rad: f64) {
        let (own, sensor) = (self.variance_rad2, noise_rad * noise_rad);
        let difference_rad = wrapped(measured_rad - self.heading_rad);
        let innovation = Innovation {
            distance: difference_rad.abs(),
            variances: [own, sensor],
        };
        let distance_rad = |last: &f64| wrapped(measured_rad - last).abs();
        let verdict = self
            .heading_gate
            .check(measured_rad, &innovation, distance_rad);
        if let Some(own) = prior_variance(verdict, own) {
            let gain = gain(own, sensor);
            self.heading_rad = wrapped(self.heading_rad + gain * difference_rad);
            self.variance_rad2 = posterior_variance(own, sensor);
            self.covariance = self.covariance.times(1.0 - gain);
        }
    }

    /// Corrects the position with a reading of a sensor of this noise.
    pub(super) fn correct_position(&mut self, measured: Point, noise_m: f64) {
        let (own, sensor) = (self.variance_m2, noise_m * noise_m);
        let difference = self.at.to(measured);
        let innovation = Innovation {
            distance: difference.length(),
            variances: [own, sensor],
        };
        let distance_m = |last: &Point| last.to(measured).length();
        let verdict = self.position_gate.check(measured, &innovation, distance_m);
        if let Some(own) = prior_variance(verdict, own) {
            let gain = gain(own, sensor);
            self.at = self.at.plus(difference.times(gain));
            self.variance_m2 = posterior_variance(own, sensor);
            self.covariance = self.covariance.times(1.0 - gain);
            self.age_s = 0.0;
        }
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
    use crate::perception::dead_reckoning::Odometry;

    #[test]
    fn a_pose_that_overflows_is_forgotten_and_corrected_by_the_next_readings() {
        let mut filter = PoseFilter::default();
        let correct = |filter: &mut PoseFilter| {
            filter.correct_heading(1.0, 0.1);
            filter.correct_position(Point { x: 2.0, y: 3.0 }, 0.1);
        };
        correct(&mut filter);
        let absurd = Odometry {
            elapsed_s: 0.1,
            speed_m_s: f64::INFINITY,
            turned_rad: 0.0,
        };
        filter.predict(&Displacement::along(f64::INFINITY, &absurd));
        assert_eq!(filter.pose(), None);
        correct(&mut filter);
        let pose = filter.pose().expect("both are known again");
        assert_eq!(pose.at, Point { x: 2.0, y: 3.0 });
    }
}
