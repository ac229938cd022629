//! The probability that a robot that drives straight past an item detects it.

use super::SensorSpec;
use super::detection::Detection;
use super::items::ItemsSpec;
use super::sector::Sector;
use crate::bodies::RobotSpec;
use crate::schedule::Schedule;
use base::geometry::Point;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Number of lateral distances over which a swath is averaged.
const LATERAL: u32 = 100;

/// Number of positions along the path at which a pass is evaluated: at least, and at most.
const MIN_POSITIONS: f64 = 64.0;
const MAX_POSITIONS: f64 = 500.0;

/// A robot on a straight path without obstacles, whose sensor is always on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Path {
    pub(crate) speed_m_s: f64,
    /// Time between two measurements.
    pub(crate) period_s: f64,
    /// Probability that a measurement yields nothing at all.
    pub(crate) dropout_probability: f64,
}

impl Path {
    /// Of a robot at its maximum speed with one of its sensors.
    pub(crate) fn new(robot: &RobotSpec, sensor: &SensorSpec, step_s: f64) -> Self {
        Self {
            speed_m_s: robot.drive.gain * robot.drive.max_speed_m_s,
            period_s: Schedule::new(sensor.rate_hz, step_s).period_s(step_s),
            dropout_probability: sensor.dropout_probability,
        }
    }
}

/// Probabilities to detect an item of one kind at least once in a pass, if it can be detected at all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pass {
    /// Of an item over which the centre of the robot passes.
    pub(crate) on_path: f64,
    /// Mean over all lateral distances in the swath.
    pub(crate) in_swath: f64,
    /// Width of the swath: of all lateral distances at which the sensor looks.
    pub(crate) swath_m: f64,
}

impl Pass {
    /// Of a moving robot with this detector, for items of a kind with this probability of detection per look.
    pub(crate) fn new(spec: &ItemsSpec, detection: &Detection, path: Path) -> Self {
        let looks = Looks {
            sector: Sector::new(&spec.sector),
            detection,
            path,
        };
        let [right_m, left_m] = looks.lateral_range_m();
        let swath_m = left_m - right_m;
        let lateral = (0..LATERAL)
            .map(|part| right_m + swath_m * (f64::from(part) + 0.5) / f64::from(LATERAL));
        let sum: f64 = lateral.map(|at_m| looks.detected_at(at_m)).sum();
        Self {
            on_path: looks.detected_at(0.0),
            // At its edges, the swath is narrower than the distance between measurements.
            in_swath: (sum / f64::from(LATERAL)).min(1.0 - f64::EPSILON),
            swath_m,
        }
    }
}

/// The looks of a sensor along a path.
struct Looks<'d> {
    sector: Sector,
    detection: &'d Detection,
    path: Path,
}

impl Looks<'_> {
    /// The lateral distances in view, the lowest and the highest; positive to the left.
    fn lateral_range_m(&self) -> [f64; 2] {
        let Sector {
            range_m,
            width_rad,
            facing_rad,
            ..
        } = self.sector;
        let reaches = |bearing_rad: f64| {
            let off_rad = (bearing_rad - facing_rad + 3.0 * TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            off_rad.abs() <= width_rad / 2.0
        };
        let edges = [-0.5, 0.5].map(|half| libm::sin(facing_rad + half * width_rad));
        let right = if reaches(-FRAC_PI_2) {
            -1.0
        } else {
            edges[0].min(edges[1]).min(0.0)
        };
        let left = if reaches(FRAC_PI_2) {
            1.0
        } else {
            edges[0].max(edges[1]).max(0.0)
        };
        [right, left].map(|part| part * range_m)
    }

    /// Probability that an item at a lateral distance is detected at least once. The first look may be anywhere:
    /// the result is the mean over one distance between looks.
    fn detected_at(&self, lateral_m: f64) -> f64 {
        let range_m = self.sector.range_m;
        let between_m = self.path.speed_m_s * self.path.period_s;
        // Many looks are summed as an integral.
        let apart_m = between_m.max(2.0 * range_m / MAX_POSITIONS);
        let phases = libm::ceil(MIN_POSITIONS * apart_m / (2.0 * range_m).max(apart_m));
        let mut missed = 0.0;
        let mut phase = 0.5;
        while phase < phases {
            let first_m = apart_m * phase / phases - range_m;
            missed +=
                libm::exp(self.log_missed((first_m, lateral_m), apart_m, apart_m / between_m));
            phase += 1.0;
        }
        1.0 - missed / phases
    }

    /// Logarithm of the probability that all looks miss an item, the first from a position relative to the robot,
    /// and the others evenly apart; each counts as a number of looks.
    fn log_missed(&self, (mut x, y): (f64, f64), apart_m: f64, looks: f64) -> f64 {
        let mut sum = 0.0;
        while x <= self.sector.range_m {
            let place = Point { x, y };
            if self.sector.holds(place) {
                let yields = 1.0 - self.path.dropout_probability;
                let detected = yields * self.detection.probability(place.length());
                sum += looks * libm::log1p(-detected);
            }
            x += apart_m;
        }
        sum
    }
}

#[cfg(test)]
mod tests;
