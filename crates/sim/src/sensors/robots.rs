//! Robot detector.

use super::detection::Detection;
use super::items::yes;
use super::sector::{Sector, SectorSpec};
use super::sensor_frame::{NoisePurpose, SensorFrame, blurred};
use base::geometry::Point;
use base::noise::{normal_pair, share};
use base::random::Entity;
use base::trig::wrapped;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A detector of other robots within a sector, which identifies each of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RobotsSpec {
    /// The field of view.
    #[serde(flatten)]
    pub sector: SectorSpec,
    /// Probability of detection per measurement. Without it, 1.
    pub detection_probability: Option<Detection>,
    /// Standard deviation of the measured position of a robot, along each axis, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
    /// Standard deviation of the measured heading of a robot, in degrees. Without it, headings are
    /// not measured.
    #[schemars(range(min = 0.0, max = 180.0))]
    pub course_noise_deg: Option<f64>,
    /// Whether obstacles hide robots.
    #[serde(default = "yes")]
    pub needs_line_of_sight: bool,
}

/// A detector, converted for measurements.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RobotDetector {
    pub(crate) sector: Sector,
    detection_probability: Detection,
    pub(crate) noise_m: f64,
    course_noise_rad: Option<f64>,
    needs_line_of_sight: bool,
    /// Whether it detects everything in view, at its exact position: then no random number is
    /// drawn.
    is_sure: bool,
}

impl RobotDetector {
    pub(crate) fn new(spec: &RobotsSpec) -> Self {
        let detection_probability = spec
            .detection_probability
            .clone()
            .unwrap_or(Detection::Constant(1.0));
        Self {
            sector: Sector::new(&spec.sector),
            is_sure: detection_probability == Detection::Constant(1.0) && spec.noise_m == 0.0,
            detection_probability,
            noise_m: spec.noise_m,
            course_noise_rad: spec.course_noise_deg.map(f64::to_radians),
            needs_line_of_sight: spec.needs_line_of_sight,
        }
    }

    /// Whether it detects all robots in range at their exact positions, unless an obstacle hides
    /// them.
    pub(crate) fn is_exact(&self) -> bool {
        self.sector.width_rad >= std::f64::consts::TAU
            && self.is_sure
            && self.course_noise_rad.unwrap_or(0.0) == 0.0
    }

    pub(crate) fn measures_headings(&self) -> bool {
        self.course_noise_rad.is_some()
    }

    /// The measured position of a robot at `place`, if it is detected.
    pub(crate) fn measure(
        &self,
        frame: &SensorFrame,
        place: Point,
        robot: Entity,
    ) -> Option<Point> {
        let way = frame.own(place);
        if !self.sector.holds(way) || (self.needs_line_of_sight && !frame.sees(place)) {
            return None;
        }
        if self.is_sure {
            return Some(way);
        }
        let words = frame.words_of(NoisePurpose::Thing, robot);
        let is_seen = share(words[0]) < self.detection_probability.probability(way.length());
        is_seen.then(|| blurred(way, self.noise_m, words))
    }

    /// The measured heading of a robot that heads `course_rad` to the left of the observer, if
    /// headings are measured.
    pub(crate) fn course_rad(
        &self,
        frame: &SensorFrame,
        course_rad: f64,
        robot: Entity,
    ) -> Option<f64> {
        let noise_rad = self.course_noise_rad?;
        let error_rad = if noise_rad == 0.0 {
            0.0
        } else {
            let [one, other, ..] = frame.words_of(NoisePurpose::Orientation, robot);
            noise_rad * normal_pair([one, other])[0]
        };
        Some(wrapped(course_rad + error_rad))
    }
}
