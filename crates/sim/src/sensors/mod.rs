//! The sensor manager: a referee between the world and the robots.
//!
//! A robot gets what its sensors can detect, and misses the rest. One file per sensor kind.

pub(crate) mod backlog;
pub(crate) mod believed;
pub(crate) mod blindness;
pub(crate) mod confusion;
pub mod detection;
pub mod heading;
pub mod items;
mod lookalikes;
pub(crate) mod memory;
pub(crate) mod pass;
pub(crate) mod pending;
pub mod position;
pub mod range;
pub(crate) mod rays;
pub mod robots;
pub mod sector;
pub(crate) mod sensor_frame;

use crate::schedule::{Schedule, steps_of};
use heading::HeadingSpec;
use items::{ItemDetector, ItemsSpec};
use position::{Drift, PositionSpec};
use range::{RangeSpec, Ring};
use robots::{RobotDetector, RobotsSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sensor: what it measures, when, and the power it takes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SensorSpec {
    /// Measurements per second; without it, one per time step. A measurement falls on the first
    /// step at or after its time.
    #[schemars(range(min = 0.0001, max = 10_000.0))]
    pub rate_hz: Option<f64>,
    /// Delay from a measurement until the robot has it, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub latency_s: f64,
    /// Probability that a measurement yields nothing at all. The robot keeps the values of the last
    /// successful one.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub dropout_probability: f64,
    /// Power while it is on, in watts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub power_w: f64,
    /// What it measures.
    #[serde(flatten)]
    pub measures: Measures,
}

/// What a sensor measures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Measures {
    /// Distances along rays: sonar, infrared, laser scanner.
    Range(RangeSpec),
    /// Items: a camera, a metal detector.
    Items(ItemsSpec),
    /// Other robots.
    Robots(RobotsSpec),
    /// The position of the robot: a satellite receiver.
    Position(PositionSpec),
    /// The heading of the robot: a compass.
    Heading(HeadingSpec),
}

/// A sensor, converted for the step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sensor {
    pub(crate) name: String,
    pub(crate) schedule: Schedule,
    /// From a measurement until the robot has it.
    pub(crate) latency_steps: u64,
    pub(crate) dropout_probability: f64,
    pub(crate) power_w: f64,
    pub(crate) measure: Measure,
}

/// What a sensor measures, converted for measurements.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Measure {
    Range(Ring),
    Items(ItemDetector),
    Robots(RobotDetector),
    Position { noise_m: f64, drift: Option<Drift> },
    Heading { noise_rad: f64 },
}

impl Sensor {
    /// Whether a measurement of one step is of use in a later one.
    pub(crate) fn outlasts_a_step(&self) -> bool {
        self.detects() || !self.is_immediate()
    }

    /// Whether each measurement is of the step in which the robot has it. After a dropout, the robot
    /// still has the values of an earlier step.
    pub(crate) fn is_immediate(&self) -> bool {
        let repeats = self.dropout_probability > 0.0 && !self.detects();
        self.latency_steps == 0 && self.schedule.is_every_step() && !repeats
    }

    /// Whether the robot has a measurement in the step in which it is taken.
    pub(crate) fn delivers_at_once(&self) -> bool {
        self.is_immediate() || (self.latency_steps == 0 && self.detects())
    }

    /// Whether it can measure for a body that the simulation does not move: not what states where that body is.
    pub(crate) fn can_be_virtual(&self) -> bool {
        !matches!(
            self.measure,
            Measure::Position { .. } | Measure::Heading { .. }
        )
    }

    /// Whether it detects things, instead of measuring values that the next measurement replaces.
    fn detects(&self) -> bool {
        matches!(self.measure, Measure::Items(_) | Measure::Robots(_))
    }

    /// The sensor `name` of the robot or controller kind `owner`.
    pub(crate) fn new(
        (owner, name): (&str, &str),
        spec: &SensorSpec,
        items: &[String],
        step_s: f64,
    ) -> Self {
        let schedule = Schedule::new(spec.rate_hz, step_s);
        let measure = match &spec.measures {
            Measures::Range(spec) => Measure::Range(Ring::new(spec)),
            Measures::Items(spec) => {
                let model = spec.model_key(owner, name);
                let period_s = schedule.period_s(step_s);
                Measure::Items(ItemDetector::new(spec, model, items, period_s))
            }
            Measures::Robots(spec) => Measure::Robots(RobotDetector::new(spec)),
            Measures::Position(spec) => Measure::Position {
                noise_m: spec.noise_m,
                drift: Drift::new(spec),
            },
            Measures::Heading(spec) => Measure::Heading {
                noise_rad: spec.noise_deg.to_radians(),
            },
        };
        Self {
            name: name.to_owned(),
            schedule,
            latency_steps: steps_of(spec.latency_s, step_s),
            dropout_probability: spec.dropout_probability,
            power_w: spec.power_w,
            measure,
        }
    }
}
