//! Robot detector.

use super::buffers::Buffers;
use super::detection::Detection;
use super::detection_sink::DetectionSink;
use super::scene::{Other, Scene};
use super::sector::{Sector, SectorSpec, yes};
use super::sensor_frame::{NoisePurpose, SensorFrame, blurred, polar};
use super::sensor_kind::{Amounts, Instrument, Provides, SensorContext, SensorKind, Vicinity};
use base::document::Place;
use base::error::InputError;
use base::geometry::Point;
use base::noise::{normal_pair, share};
use base::random::Entity;
use base::trig::wrapped;
use brain::{Body, Neighbour};
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

impl SensorKind for RobotsSpec {
    type Instrument = RobotDetector;
    const PROVIDES: &'static [Provides] = &[Provides::Robots];
    const EXAMPLE: &'static str = "eye = { kind = \"robots\", range_m = 10 }";
    const FOR_CONTROLLERS: bool = true;

    fn instrument(&self, _context: &SensorContext) -> RobotDetector {
        RobotDetector::new(self)
    }

    fn range_m(&self) -> Option<f64> {
        Some(self.sector.range_m)
    }

    fn extend_body(&self, _context: &SensorContext, body: &mut Body) {
        body.neighbour_noise_m = body.neighbour_noise_m.max(self.noise_m);
    }

    fn amounts(&self, _period_s: f64, around: &impl Vicinity) -> Amounts {
        Amounts {
            neighbours: around.robots_within(self.sector.range_m),
            ..Amounts::default()
        }
    }

    fn errors(&self, _context: &SensorContext, at: &Place) -> Vec<InputError> {
        let detection = self.detection_probability.as_ref();
        let error = detection.and_then(|each| each.error(&at.key("detection_probability")));
        error.into_iter().collect()
    }
}

/// A detector, converted for measurements.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RobotDetector {
    sector: Sector,
    detection_probability: Detection,
    noise_m: f64,
    course_noise_rad: Option<f64>,
    needs_line_of_sight: bool,
    /// Whether it detects everything in view, at its exact position: then no random number is
    /// drawn.
    is_sure: bool,
}

impl Instrument for RobotDetector {
    const DETECTS: bool = true;

    fn measure(
        &self,
        frame: &SensorFrame,
        scene: &impl Scene,
        buffers: &mut Buffers,
        sink: &mut impl DetectionSink,
    ) {
        let (others, range_m) = (&mut buffers.others, self.sector.range_m);
        scene.others_within(range_m, others);
        let is_clear = scene.is_clear(range_m, others);
        for number in others.iter() {
            let other = scene.other(*number);
            let frame = SensorFrame {
                geometry: other.geometry,
                is_clear,
                ..*frame
            };
            if let Some(way) = self.detected(&frame, &other) {
                let (range_m, bearing_rad) = polar(way);
                let turned_rad = scene.heading_rad_of(*number) - scene.heading_rad();
                sink.add_neighbour(Neighbour {
                    range_m,
                    bearing_rad,
                    course_rad: self.course_rad(&frame, turned_rad, other.key),
                    age_s: 0.0,
                    uncertainty_m: other.uncertainty_m,
                    id: other.id,
                });
            }
        }
    }
}

impl RobotDetector {
    fn new(spec: &RobotsSpec) -> Self {
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

    /// The measured position of another, if it is detected.
    #[inline]
    fn detected(&self, frame: &SensorFrame, other: &Other) -> Option<Point> {
        let way = frame.own(other.at);
        if !self.sector.holds(way) || (self.needs_line_of_sight && !frame.sees(other.at)) {
            return None;
        }
        if self.is_sure {
            return Some(way);
        }
        let words = frame.words_of(NoisePurpose::Thing, other.key);
        let is_seen = share(words[0]) < self.detection_probability.probability(way.length());
        is_seen.then(|| blurred(way, self.noise_m, words))
    }

    /// The measured heading of a robot that heads `course_rad` to the left of the observer, if
    /// headings are measured.
    fn course_rad(&self, frame: &SensorFrame, course_rad: f64, robot: Entity) -> Option<f64> {
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
