//! How a drive executes commanded motion: learnt from readings, where the robot does not measure its
//! own motion.
//!
//! A drive may be slower or faster than commanded, turn more or less, pull to one side, and follow
//! with a lag. The [pose filter](super::pose_filter) estimates these together with the pose: each
//! reading that differs from the prediction corrects them in proportion to their share of the error.
//!
//! A speed that changes, by slipping or because something blocks the robot, shows in successive
//! positions that are all ahead or all behind. [`Trend`] notices that and lets the estimate of the
//! speed follow faster.

use super::displacement::Displacement;
use base::hashed::Hashed;

/// Standard deviations before any reading: of the factors on commanded speed and turn rate, of the
/// curvature in rad/m, and of the lag in seconds.
pub(super) const SCALE_DEVIATION: f64 = 0.25;
pub(super) const CURVATURE_DEVIATION: f64 = 0.15;
pub(super) const LAG_DEVIATION_S: f64 = 0.2;

/// The lag that is assumed before any reading, in seconds.
const PRIOR_LAG_S: f64 = 0.25;

/// Limits of what can be learnt: a drive neither moves backwards nor is more than twice as fast.
const MAX_SCALE: f64 = 2.0;
const MAX_LAG_S: f64 = 2.0;

/// Random walk of the factor on the turn rate and of the curvature, per square root of a second of
/// motion.
const TURN_SCALE_RATE: f64 = 0.005;
const CURVATURE_RATE: f64 = 0.003;

/// The same for the factor on the speed: least and most.
const MIN_SCALE_RATE: f64 = 0.0007;
const MAX_SCALE_RATE: f64 = 0.2;

/// A speed that has changed may be any, with this standard deviation of its factor.
pub(super) const CHANGED_DEVIATION: f64 = 0.5;

/// A body that is certainly slower than this fraction of a commanded speed is blocked. Slower commands,
/// in m/s, do not count.
const BLOCKED_SCALE: f64 = 0.2;
const MIN_COMMANDED_M_S: f64 = 0.05;

/// The estimated parameters of a drive, and the motion of its body by them.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct DriveEstimate {
    /// Factors on commanded speed and turn rate.
    pub(super) speed_scale: f64,
    pub(super) turn_scale: f64,
    /// By how much its path turns left, in rad/m.
    pub(super) curvature_rad_m: f64,
    pub(crate) lag_s: f64,
    /// Commanded speed and turn rate that have taken effect.
    speed_m_s: f64,
    turn_rate_rad_s: f64,
}

impl Default for DriveEstimate {
    fn default() -> Self {
        Self {
            lag_s: PRIOR_LAG_S,
            ..Self::EXACT
        }
    }
}

impl DriveEstimate {
    /// Of odometry without errors.
    pub(super) const EXACT: Self = Self {
        speed_scale: 1.0,
        turn_scale: 1.0,
        curvature_rad_m: 0.0,
        lag_s: 0.0,
        speed_m_s: 0.0,
        turn_rate_rad_s: 0.0,
    };
}

/// The effect of a commanded displacement with the lag of a drive, before its factors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lagged {
    pub(super) path_m: f64,
    pub(super) turned_rad: f64,
    /// Changes of the speed and the turn rate that have taken effect.
    pub(super) speed_change_m_s: f64,
    pub(super) rate_change_rad_s: f64,
}

impl DriveEstimate {
    /// The effect of a commanded displacement. With a first-order lag T, the body loses the distance
    /// T x (change of its speed), whatever is commanded in between.
    pub(super) fn lagged(&self, moved: &Displacement) -> Lagged {
        let share = if self.lag_s > 0.0 {
            -libm::expm1(-moved.elapsed_s / self.lag_s)
        } else {
            1.0
        };
        let mean_m_s = moved.path_m / moved.elapsed_s.max(f64::MIN_POSITIVE);
        let speed_change_m_s = share * (mean_m_s - self.speed_m_s);
        let rate_change_rad_s = share * (moved.turn_rate_rad_s() - self.turn_rate_rad_s);
        Lagged {
            path_m: moved.path_m - self.lag_s * speed_change_m_s,
            turned_rad: moved.turned_rad - self.lag_s * rate_change_rad_s,
            speed_change_m_s,
            rate_change_rad_s,
        }
    }

    /// The displacement of the body.
    pub(super) fn executed(&self, moved: &Displacement, lagged: &Lagged) -> Displacement {
        let by_curvature_rad = self.curvature_rad_m * lagged.path_m;
        moved.executed(
            self.speed_scale * lagged.path_m,
            self.turn_scale * lagged.turned_rad + by_curvature_rad,
        )
    }

    /// Updates the speed and the turn rate after a displacement.
    pub(super) fn advance(&mut self, lagged: &Lagged) {
        self.speed_m_s += lagged.speed_change_m_s;
        self.turn_rate_rad_s += lagged.rate_change_rad_s;
    }

    /// The distance by which a body coasts that changes to another motion.
    pub(super) fn coasted_m(&self, to: &Displacement) -> f64 {
        self.speed_scale * (self.speed_m_s - to.to_m_s) * self.lag_s
    }

    /// The same for the angle.
    pub(super) fn coasted_rad(&self, to: &Displacement) -> f64 {
        self.turn_scale * (self.turn_rate_rad_s - to.turn_rate_rad_s()) * self.lag_s
    }

    /// Updates both after a displacement that the robot has measured.
    pub(super) fn follow(&mut self, moved: &Displacement) {
        self.speed_m_s = moved.to_m_s;
        self.turn_rate_rad_s = moved.turn_rate_rad_s();
    }

    /// Keeps the parameters within their limits.
    pub(super) fn limit(&mut self) {
        self.speed_scale = self.speed_scale.clamp(0.0, MAX_SCALE);
        self.turn_scale = self.turn_scale.clamp(0.0, MAX_SCALE);
        self.lag_s = self.lag_s.clamp(0.0, MAX_LAG_S);
    }

    /// Whether the body does not move although it is commanded to, if the factor on its speed has this
    /// standard deviation.
    pub(super) fn is_blocked(&self, deviation: f64) -> bool {
        let is_commanded = self.speed_m_s.abs() > MIN_COMMANDED_M_S;
        is_commanded && self.speed_scale + 2.0 * deviation < BLOCKED_SCALE
    }

    /// Speed of the body.
    pub(crate) fn speed_m_s(&self) -> f64 {
        self.speed_scale * self.speed_m_s
    }

    /// The angle by which the body still turns after the command to stop turning.
    pub(crate) fn coasting_rad(&self) -> f64 {
        self.turn_scale * self.turn_rate_rad_s * self.lag_s
    }
}

/// Variances by which the parameters of a drive may change in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct RandomWalk {
    pub(super) speed_scale: f64,
    pub(super) turn_scale: f64,
    pub(super) curvature: f64,
}

/// The random walk of the parameters during a lagged displacement.
pub(super) fn random_walk(lagged: &Lagged, elapsed_s: f64, trend: &Trend) -> RandomWalk {
    let driving_s = if lagged.path_m == 0.0 { 0.0 } else { elapsed_s };
    let turning_s = if lagged.turned_rad == 0.0 {
        0.0
    } else {
        elapsed_s
    };
    RandomWalk {
        speed_scale: trend.rate2 * driving_s,
        turn_scale: TURN_SCALE_RATE * TURN_SCALE_RATE * turning_s,
        curvature: CURVATURE_RATE * CURVATURE_RATE * driving_s,
    }
}

/// Whether successive positions are all ahead of the estimate, or all behind it, and how fast the
/// factor on the speed changes by that.
///
/// The differences along the path, in standard deviations, are smoothed; if the estimate is right,
/// they have no trend. The rate grows while there is one, and decays slowly.
#[derive(Debug, Clone, Copy, Hashed)]
pub(super) struct Trend {
    /// Natural logarithm of the square of the rate, and the square itself.
    log_rate2: f64,
    #[hashed(skip)]
    rate2: f64,
    smoothed: f64,
    /// Time since the last position, and the distance commanded in it.
    since_s: f64,
    pub(super) since_m: f64,
}

/// Time constant of the smoothing, in seconds.
const SMOOTHING_S: f64 = 2.8;

/// Squared standard deviations that are no trend, and most that count.
const NO_TREND: f64 = 5.5;
const MAX_TREND: f64 = 6.0;

/// Change of the logarithm per second: growth with a trend, and decay.
const GROWTH_S: f64 = 4.0;
const DECAY_S: f64 = 0.05;

/// Differences count up to this number of standard deviations.
const MAX_DEVIATIONS: f64 = 3.0;

impl Default for Trend {
    fn default() -> Self {
        let log_rate2 = 2.0 * libm::log(MIN_SCALE_RATE);
        Self {
            log_rate2,
            rate2: libm::exp(log_rate2),
            smoothed: 0.0,
            since_s: 0.0,
            since_m: 0.0,
        }
    }
}

impl Trend {
    /// Notes a displacement.
    pub(super) fn advance(&mut self, elapsed_s: f64, path_m: f64) {
        self.since_s += elapsed_s;
        self.since_m += path_m;
    }

    /// Takes a position that is ahead of the estimate by a number of standard deviations.
    pub(super) fn observe(&mut self, ahead: f64) {
        let elapsed_s = core::mem::take(&mut self.since_s).min(SMOOTHING_S);
        if core::mem::take(&mut self.since_m) == 0.0 || elapsed_s <= 0.0 {
            return;
        }
        let keep = libm::exp(-elapsed_s / SMOOTHING_S);
        let ahead = ahead.clamp(-MAX_DEVIATIONS, MAX_DEVIATIONS);
        self.smoothed = keep * self.smoothed + (1.0 - keep) * ahead;
        // Variance of the smoothed value without a trend: (1 - keep) / (1 + keep).
        let squared = self.smoothed * self.smoothed * (1.0 + keep) / (1.0 - keep);
        let growth = GROWTH_S * (squared - NO_TREND).clamp(0.0, MAX_TREND);
        let [low, high] = [MIN_SCALE_RATE, MAX_SCALE_RATE].map(|rate| 2.0 * libm::log(rate));
        self.log_rate2 = (self.log_rate2 + (growth - DECAY_S) * elapsed_s).clamp(low, high);
        self.rate2 = libm::exp(self.log_rate2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::perception::dead_reckoning::Odometry;

    /// The commanded displacement of a step of 0.1 s.
    fn commanded(speed_m_s: f64, turn_rate_rad_s: f64) -> Displacement {
        let odometry = Odometry {
            elapsed_s: 0.1,
            speed_m_s,
            turned_rad: 0.1 * turn_rate_rad_s,
            is_commanded: true,
        };
        Displacement::along(0.1 * speed_m_s, &odometry)
    }

    /// The path and the turn of a drive with a lag that executes a motion for some steps.
    fn executed(drive: &mut DriveEstimate, motion: [f64; 2], steps: u32) -> [f64; 2] {
        let moved = commanded(motion[0], motion[1]);
        (0..steps).fold([0.0; 2], |[path_m, turned_rad], _| {
            let lagged = drive.lagged(&moved);
            let executed = drive.executed(&moved, &lagged);
            drive.advance(&lagged);
            [path_m + executed.path_m, turned_rad + executed.turned_rad]
        })
    }

    #[test]
    fn a_drive_with_a_lag_loses_the_lag_times_the_speed_and_coasts_as_far() {
        let mut drive = DriveEstimate {
            lag_s: 0.4,
            ..DriveEstimate::default()
        };
        let [path_m, turned_rad] = executed(&mut drive, [0.6, 0.5], 100);
        assert!((path_m - (6.0 - 0.4 * 0.6)).abs() < 1e-9, "{path_m}");
        assert!((turned_rad - (5.0 - 0.4 * 0.5)).abs() < 1e-9);
        assert!((drive.coasting_rad() - 0.4 * 0.5).abs() < 1e-9);
        let [path_m, turned_rad] = executed(&mut drive, [0.0, 0.0], 100);
        assert!((path_m - 0.4 * 0.6).abs() < 1e-9, "{path_m}");
        assert!((turned_rad - 0.4 * 0.5).abs() < 1e-9);
    }

    #[test]
    fn factors_and_curvature_change_the_path() {
        let mut drive = DriveEstimate {
            speed_scale: 0.5,
            turn_scale: 2.0,
            curvature_rad_m: 0.1,
            lag_s: 0.0,
            ..DriveEstimate::default()
        };
        let [path_m, turned_rad] = executed(&mut drive, [1.0, 0.3], 10);
        assert!((path_m - 0.5).abs() < 1e-12);
        assert!((turned_rad - (2.0 * 0.3 + 0.1)).abs() < 1e-12);
    }

    /// The rate after positions, one per second, that are ahead by these standard deviations.
    fn rate_after(trend: &mut Trend, ahead: impl Iterator<Item = f64>) -> f64 {
        for ahead in ahead {
            trend.advance(1.0, 0.5);
            trend.observe(ahead);
        }
        libm::exp(trend.log_rate2 / 2.0)
    }

    #[test]
    fn positions_that_are_all_ahead_let_the_speed_change_and_others_do_not() {
        let mut trend = Trend::default();
        let alternating = (0..100).map(|number| if number % 2 == 0 { 2.0 } else { -2.0 });
        assert!(rate_after(&mut trend, alternating) < 1.01 * MIN_SCALE_RATE);
        assert!(rate_after(&mut trend, [2.0; 8].into_iter()) > 0.1);
        assert!(rate_after(&mut trend, [0.0; 400].into_iter()) < 0.01);
        assert!(rate_after(&mut trend, [-2.0; 8].into_iter()) > 0.1);
    }

    #[test]
    fn positions_of_a_robot_that_stands_are_no_trend() {
        let mut trend = Trend::default();
        for _ in 0..100 {
            trend.advance(1.0, 0.0);
            trend.observe(3.0);
        }
        assert!(libm::exp(trend.log_rate2 / 2.0) < 1.01 * MIN_SCALE_RATE);
    }
}
