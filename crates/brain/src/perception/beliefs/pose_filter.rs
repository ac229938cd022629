//! The filter that estimates the pose of the robot at one moment.
//!
//! It is an extended Kalman filter of position and heading. It also estimates by which factors the
//! robot's odometry is wrong or, while the robot does not measure its own motion, [how its drive
//! executes commands](super::drive_estimate).

use super::covariance::Covariance;
use super::displacement::{Displacement, ODOMETRY_ERROR};
use super::drive_estimate::{
    CHANGED_DEVIATION, CURVATURE_DEVIATION, DriveEstimate, LAG_DEVIATION_S, Lagged,
    SCALE_DEVIATION, Trend, random_walk,
};
use super::pose::{Pose, turned};
use super::validation_gate::{Innovation, ValidationGate, Verdict};
use crate::io::body::Body;
use crate::perception::sector::direction;
use alloc::boxed::Box;
use base::geometry::Point;
use base::hashed::Hashed;
use base::trig::wrapped;

/// The estimated quantities: the pose, then the parameters of the drive.
const X: usize = 0;
const Y: usize = 1;
const HEADING: usize = 2;
const POSE_STATES: usize = 3;
const SPEED_SCALE: usize = 3;
const TURN_SCALE: usize = 4;
const CURVATURE: usize = 5;
const LAG: usize = 6;
const STATES: usize = 7;

/// Squared standard deviations of a position beyond which the speed of the robot has changed: 1 of
/// 1,000 positions without a change, exp(-13.8 / 2).
const MAX_UNCHANGED: f64 = 13.8;

/// Variance of the heading, in rad², above which the filter is not linear any more: a reading may be off
/// by a whole turn, and the direction of the motion is unknown.
const MAX_HEADING_RAD2: f64 = 0.5;

/// A drift is not faster than this.
const MIN_DRIFT_S: f64 = 0.1;

/// The state of the filter.
#[derive(Debug, Default, Hashed)]
pub(super) struct PoseFilter {
    pose: PoseState,
    /// Of the drive from the first commanded motion on, and of the odometry until then, where the
    /// position sensor is not exact.
    drive: Option<Box<DriveFilter>>,
}

/// The estimated pose. Its covariance counts only while no drive is estimated.
#[derive(Debug, Clone, Copy, Hashed)]
struct PoseState {
    at: Point,
    heading_rad: f64,
    covariance: Covariance<POSE_STATES>,
    knows_position: bool,
    knows_heading: bool,
    /// Whether the heading was so uncertain since the last position that only the next one counts.
    is_lost: bool,
    position_gate: ValidationGate<Point>,
    heading_gate: ValidationGate<f64>,
    /// The variance of the slow part of the errors of the position sensor: positions do not reveal it,
    /// so the estimate follows it.
    #[hashed(skip)]
    drift_m2: f64,
    /// Time since the last position reading.
    age_s: f64,
}

/// The estimated drive, and the covariance of pose and drive.
#[derive(Debug, Clone, Copy, Hashed)]
struct DriveFilter {
    /// Whether it estimates the drive, and not the odometry.
    #[hashed(skip)]
    is_commanded: bool,
    estimate: DriveEstimate,
    trend: Trend,
    covariance: Covariance<STATES>,
}

impl Default for PoseState {
    fn default() -> Self {
        Self {
            at: Point::default(),
            heading_rad: 0.0,
            covariance: Covariance::EXACT,
            knows_position: false,
            knows_heading: false,
            is_lost: false,
            position_gate: ValidationGate::default(),
            heading_gate: ValidationGate::default(),
            drift_m2: 0.0,
            age_s: 0.0,
        }
    }
}

impl DriveFilter {
    /// Of odometry: its factors are nearly right, and it has neither curvature nor lag.
    fn of_odometry(pose: &Covariance<POSE_STATES>) -> Self {
        let mut covariance = pose.extended();
        for state in [SPEED_SCALE, TURN_SCALE] {
            covariance.set_independent(state, ODOMETRY_ERROR * ODOMETRY_ERROR);
        }
        Self {
            is_commanded: false,
            estimate: DriveEstimate::EXACT,
            trend: Trend::default(),
            covariance,
        }
    }

    /// Nothing of the drive is known yet.
    fn new(pose: &Covariance<POSE_STATES>) -> Self {
        let mut covariance = pose.extended();
        for (state, deviation) in [
            (SPEED_SCALE, SCALE_DEVIATION),
            (TURN_SCALE, SCALE_DEVIATION),
            (CURVATURE, CURVATURE_DEVIATION),
            (LAG, LAG_DEVIATION_S),
        ] {
            covariance.set_independent(state, deviation * deviation);
        }
        Self {
            is_commanded: true,
            estimate: DriveEstimate::default(),
            trend: Trend::default(),
            covariance,
        }
    }
}

impl Clone for PoseFilter {
    fn clone(&self) -> Self {
        Self {
            pose: self.pose,
            drive: self.drive.clone(),
        }
    }

    /// Allocates nothing if both estimate a drive.
    fn clone_from(&mut self, source: &Self) {
        self.pose = source.pose;
        match (&mut self.drive, &source.drive) {
            (Some(drive), Some(source)) => **drive = **source,
            (drive, source) => drive.clone_from(source),
        }
    }
}

impl PoseFilter {
    /// The pose, once a position and a heading are known.
    pub(super) fn pose(&self) -> Option<Pose> {
        let state = &self.pose;
        let variance_m2 = f64::midpoint(self.covariance(X, X), self.covariance(Y, Y));
        (state.knows_position && state.knows_heading).then(|| Pose {
            at: state.at,
            heading_rad: state.heading_rad,
            deviation_m: libm::sqrt(variance_m2 + state.drift_m2),
            deviation_rad: libm::sqrt(self.covariance(HEADING, HEADING)),
            age_s: state.age_s,
        })
    }

    /// How the drive executes commanded motion; `None` while the robot has measured all of its motion.
    pub(super) fn drive(&self) -> Option<&DriveEstimate> {
        let drive = self.drive.as_deref().filter(|drive| drive.is_commanded)?;
        Some(&drive.estimate)
    }

    /// Whether the body does not move although it is commanded to, as far as positions show.
    pub(super) fn is_blocked(&self) -> bool {
        self.drive.as_deref().is_some_and(|drive| {
            let deviation = libm::sqrt(drive.covariance.get(SPEED_SCALE, SPEED_SCALE));
            drive.is_commanded && drive.estimate.is_blocked(deviation)
        })
    }

    fn covariance(&self, row: usize, column: usize) -> f64 {
        match &self.drive {
            Some(drive) => drive.covariance.get(row, column),
            None => self.pose.covariance.get(row, column),
        }
    }

    fn add_variance(&mut self, of: usize, variance: f64) {
        match &mut self.drive {
            Some(drive) => drive.covariance.add_variance(of, variance),
            None => self.pose.covariance.add_variance(of, variance),
        }
    }

    fn set_independent(&mut self, of: usize, variance: f64) {
        match &mut self.drive {
            Some(drive) => drive.covariance.set_independent(of, variance),
            None => self.pose.covariance.set_independent(of, variance),
        }
    }

    /// The displacement of the body where this one was commanded or measured.
    pub(super) fn executed(&self, moved: &Displacement) -> Displacement {
        let drive = self.drive.as_deref();
        let drive = match drive.filter(|drive| drive.is_commanded == moved.is_commanded) {
            Some(drive) => drive.estimate,
            None if moved.is_commanded => DriveEstimate::default(),
            None => return *moved,
        };
        drive.executed(moved, &drive.lagged(moved))
    }

    /// Predicts the pose after a displacement.
    pub(super) fn predict(&mut self, moved: &Displacement, body: &Body) {
        self.pose.age_s += moved.elapsed_s;
        self.prepare_drive(moved, body);
        match &self.drive {
            Some(drive) if drive.is_commanded == moved.is_commanded => self.predict_scaled(moved),
            _ => self.predict_measured(moved),
        }
        self.pose.drift_m2 = body.position_drift_m * body.position_drift_m;
        let followed_m2 =
            4.0 * self.pose.drift_m2 * moved.elapsed_s / body.position_drift_s.max(MIN_DRIFT_S);
        let variance_m2 = moved.variance_m2 + followed_m2;
        self.add_variance(X, variance_m2);
        self.add_variance(Y, variance_m2);
        self.add_variance(HEADING, moved.variance_rad2);
        self.pose.is_lost |= self.covariance(HEADING, HEADING) > MAX_HEADING_RAD2;
        self.forget_overflow();
    }

    /// A robot that is stopped from outside measures a speed of zero at once, although its body coasts:
    /// what a change of speed contradicts is an error of the position.
    fn predict_measured(&mut self, moved: &Displacement) {
        if let Some(drive) = &mut self.drive {
            let coasted_m = drive.estimate.coasted_m(moved);
            let coasted_rad = drive.estimate.coasted_rad(moved);
            drive.covariance.add_variance(X, coasted_m * coasted_m);
            drive.covariance.add_variance(Y, coasted_m * coasted_m);
            drive
                .covariance
                .add_variance(HEADING, coasted_rad * coasted_rad);
            drive.estimate.follow(moved);
            drive.trend.advance(moved.elapsed_s, 0.0);
        }
        self.move_by(moved);
    }

    /// Starts the estimate of the drive with the first commanded motion. Without any, it is that of
    /// the odometry, where positions could not correct its errors at once.
    fn prepare_drive(&mut self, moved: &Displacement, body: &Body) {
        match &mut self.drive {
            None if moved.is_commanded => {
                self.drive = Some(Box::new(DriveFilter::new(&self.pose.covariance)));
            }
            None if body.position_noise_m > 0.0 => {
                self.drive = Some(Box::new(DriveFilter::of_odometry(&self.pose.covariance)));
            }
            Some(drive) if moved.is_commanded && !drive.is_commanded => {
                **drive = DriveFilter::new(&drive.covariance.extended());
            }
            _ => {}
        }
    }

    /// Predicts by the factors of the drive or of the odometry.
    fn predict_scaled(&mut self, moved: &Displacement) {
        let Some(drive) = self.drive.as_deref() else {
            return;
        };
        let lagged = drive.estimate.lagged(moved);
        let executed = drive.estimate.executed(moved, &lagged);
        let front = turned(executed.front(), direction(self.pose.heading_rad));
        self.move_by(&executed);
        if let Some(drive) = &mut self.drive {
            drive.depend_on_drive(&lagged, front);
            drive.advance(&lagged, moved.elapsed_s);
        }
    }

    /// Moves the estimate. A heading error leads to a lateral position error.
    fn move_by(&mut self, moved: &Displacement) {
        let state = &mut self.pose;
        if !state.knows_heading {
            // The direction of the motion is unknown.
            state.knows_position &= moved.chord == Point::default();
            return;
        }
        let motion = turned(moved.chord, direction(state.heading_rad));
        state.at = state.at.plus(motion);
        state.heading_rad = wrapped(state.heading_rad + moved.turned_rad);
        state.position_gate.predict(|at| at.plus(motion));
        state
            .heading_gate
            .predict(|heading_rad| heading_rad + moved.turned_rad);
        if let Some(drive) = &mut self.drive {
            drive.covariance.add_multiple(HEADING, -motion.y, X);
            drive.covariance.add_multiple(HEADING, motion.x, Y);
        } else {
            state.covariance.add_multiple(HEADING, -motion.y, X);
            state.covariance.add_multiple(HEADING, motion.x, Y);
        }
    }

    /// Forgets a pose that is not finite, such as that of a body of absurd speed: no reading could
    /// correct it.
    fn forget_overflow(&mut self) {
        let state = &self.pose;
        let covariance = match &self.drive {
            Some(drive) => drive.covariance.is_finite(),
            None => state.covariance.is_finite(),
        };
        if !((state.at.x + state.at.y + state.heading_rad).is_finite() && covariance) {
            *self = Self::default();
        }
    }

    /// Corrects the heading with a reading of a sensor of this noise.
    pub(super) fn correct_heading(&mut self, measured_rad: f64, noise_rad: f64) {
        let sensor = noise_rad * noise_rad;
        let difference_rad = wrapped(measured_rad - self.pose.heading_rad);
        let innovation = Innovation {
            distance: difference_rad.abs(),
            variances: [self.covariance(HEADING, HEADING), sensor],
        };
        let distance_rad = |last: &f64| wrapped(measured_rad - last).abs();
        let is_linear = innovation.variances[0] <= MAX_HEADING_RAD2;
        let gate = &mut self.pose.heading_gate;
        let verdict = if self.pose.knows_heading && is_linear {
            gate.check(measured_rad, &innovation, distance_rad)
        } else {
            Verdict::Reset
        };
        match verdict {
            Verdict::Accept => self.correct(HEADING, difference_rad, sensor),
            Verdict::Reset => {
                self.pose.heading_rad = wrapped(measured_rad);
                self.pose.knows_heading = true;
                self.set_independent(HEADING, sensor);
            }
            Verdict::Reject => {}
        }
    }

    /// Corrects the position with a reading of a sensor of this noise.
    pub(super) fn correct_position(&mut self, measured: Point, noise_m: f64) {
        let sensor = noise_m * noise_m;
        let difference = self.pose.at.to(measured);
        if !self.pose.is_lost {
            self.notice_changed_speed(difference, sensor);
        }
        let innovation = Innovation {
            distance: difference.length(),
            variances: [self.variance_along(difference), sensor],
        };
        let distance_m = |last: &Point| last.to(measured).length();
        let gate = &mut self.pose.position_gate;
        let verdict = if self.pose.knows_position && !self.pose.is_lost {
            gate.check(measured, &innovation, distance_m)
        } else {
            Verdict::Reset
        };
        match verdict {
            Verdict::Accept => {
                self.observe_trend(difference, sensor);
                self.correct(X, difference.x, sensor);
                // The first coordinate has changed what is known of the second.
                self.correct(Y, self.pose.at.to(measured).y, sensor);
            }
            Verdict::Reset => {
                self.pose.at = measured;
                (self.pose.knows_position, self.pose.is_lost) = (true, false);
                self.set_independent(X, sensor);
                self.set_independent(Y, sensor);
            }
            Verdict::Reject => return,
        }
        self.pose.age_s = 0.0;
    }

    /// Corrects everything that depends on a quantity by the difference of a reading of it.
    fn correct(&mut self, of: usize, difference: f64, sensor: f64) {
        let state = &mut self.pose;
        let [x, y, heading] = match &mut self.drive {
            None => state.covariance.measure(of, sensor),
            Some(drive) => drive.correct(of, difference, sensor),
        };
        state.at.x += x * difference;
        state.at.y += y * difference;
        state.heading_rad = wrapped(state.heading_rad + heading * difference);
    }

    /// The variance of the position in a direction.
    fn variance_along(&self, way: Point) -> f64 {
        let length2 = way.length_squared();
        if length2 <= 0.0 {
            return self.covariance(X, X);
        }
        let sum = way.x * way.x * self.covariance(X, X)
            + 2.0 * way.x * way.y * self.covariance(X, Y)
            + way.y * way.y * self.covariance(Y, Y);
        (sum / length2).max(0.0)
    }

    /// Lets the estimated speed follow faster if positions are all ahead, or all behind.
    fn observe_trend(&mut self, difference: Point, sensor: f64) {
        let Some(drive) = &self.drive else {
            return;
        };
        let way = direction(self.pose.heading_rad).times(drive.trend.since_m.signum());
        let deviation_m = libm::sqrt(self.variance_along(way) + sensor);
        if let Some(drive) = self.drive.as_mut().filter(|_| deviation_m > 0.0) {
            drive.trend.observe(difference.dot(way) / deviation_m);
        }
    }

    /// If a position is farther off than chance explains, the speed may have changed since the last
    /// one: its factor is unknown again, and so is the part of the path since then. A position that
    /// this does not explain either is left to the gate.
    fn notice_changed_speed(&mut self, difference: Point, sensor: f64) {
        if self.drive().is_none() {
            return;
        }
        let own = self.variance_along(difference);
        let distance_m2 = difference.length_squared();
        let is_expected = distance_m2 <= MAX_UNCHANGED * (own + sensor);
        let Some(drive) = self.drive.as_mut().filter(|_| !is_expected) else {
            return;
        };
        if drive.trend.since_m == 0.0 {
            return;
        }
        let before = drive.covariance;
        let path = direction(self.pose.heading_rad).times(drive.trend.since_m);
        let covariance = &mut drive.covariance;
        covariance.set_independent(SPEED_SCALE, CHANGED_DEVIATION * CHANGED_DEVIATION);
        covariance.add_multiple(SPEED_SCALE, path.x, X);
        covariance.add_multiple(SPEED_SCALE, path.y, Y);
        let innovation = Innovation {
            distance: libm::sqrt(distance_m2),
            variances: [self.variance_along(difference), sensor],
        };
        if let Some(drive) = self.drive.as_mut().filter(|_| innovation.is_outside()) {
            drive.covariance = before;
        }
    }
}

impl DriveFilter {
    /// Adds to the errors of the pose what the errors of the drive contributed to a displacement in
    /// the direction of `front`: those of its length, and of its turn, of which half bends the path.
    fn depend_on_drive(&mut self, lagged: &Lagged, front: Point) {
        let DriveEstimate {
            speed_scale,
            turn_scale,
            curvature_rad_m,
            ..
        } = self.estimate;
        let (speed_m_s, rate_rad_s) = (lagged.speed_change_m_s, lagged.rate_change_rad_s);
        let by_lag_rad = -(turn_scale * rate_rad_s + curvature_rad_m * speed_m_s);
        let half_path_m = speed_scale * lagged.path_m / 2.0;
        let parts = [
            (SPEED_SCALE, lagged.path_m, 0.0),
            (TURN_SCALE, 0.0, lagged.turned_rad),
            (CURVATURE, 0.0, lagged.path_m),
            (LAG, -speed_scale * speed_m_s, by_lag_rad),
        ];
        // Odometry has only factors.
        let count = if self.is_commanded { parts.len() } else { 2 };
        for (state, along_m, turned_rad) in parts.into_iter().take(count) {
            let aside_m = half_path_m * turned_rad;
            let covariance = &mut self.covariance;
            covariance.add_multiple(state, along_m * front.x - aside_m * front.y, X);
            covariance.add_multiple(state, along_m * front.y + aside_m * front.x, Y);
            covariance.add_multiple(state, turned_rad, HEADING);
        }
    }

    /// Updates the drive after a displacement, during which it may have changed.
    fn advance(&mut self, lagged: &Lagged, elapsed_s: f64) {
        self.estimate.advance(lagged);
        self.trend.advance(elapsed_s, lagged.path_m);
        let walk = random_walk(lagged, elapsed_s, &self.trend);
        self.covariance.add_variance(SPEED_SCALE, walk.speed_scale);
        self.covariance.add_variance(TURN_SCALE, walk.turn_scale);
        if self.is_commanded {
            self.covariance.add_variance(CURVATURE, walk.curvature);
        }
    }

    /// Corrects the drive by the difference of a reading, and returns the gains of the pose.
    fn correct(&mut self, of: usize, difference: f64, sensor: f64) -> [f64; POSE_STATES] {
        let gains = self.covariance.measure(of, sensor);
        let estimate = &mut self.estimate;
        estimate.speed_scale += gains[SPEED_SCALE] * difference;
        estimate.turn_scale += gains[TURN_SCALE] * difference;
        estimate.curvature_rad_m += gains[CURVATURE] * difference;
        estimate.lag_s += gains[LAG] * difference;
        estimate.limit();
        [gains[X], gains[Y], gains[HEADING]]
    }
}

#[cfg(test)]
mod tests;
