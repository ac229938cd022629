//! A sensor: what it measures, when, and the power it takes.

use super::sensor_frame::{NoisePurpose, SensorFrame};
use super::sensor_kind::{KindFacts, Provides, SensorContext};
use super::{Measure, Measures};
use crate::schedule::{Schedule, steps_of};
use base::noise::share;
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

impl SensorSpec {
    /// What it depends on besides its own keys, as the sensor with a number and a name of the robot or controller kind
    /// `owner`.
    #[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
    pub(crate) fn context<'a>(
        &self,
        number: u16,
        (owner, name): (&'a str, &'a str),
        item_kinds: &'a [String],
        step_s: f64,
    ) -> SensorContext<'a> {
        SensorContext {
            owner,
            name,
            number,
            item_kinds,
            period_s: Schedule::new(self.rate_hz, step_s).period_s(step_s),
            latency_s: steps_of(self.latency_s, step_s) as f64 * step_s,
        }
    }

    /// Whether it provides something.
    pub(crate) fn provides(&self, what: Provides) -> bool {
        self.measures.facts().provides(what)
    }
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
    /// Maximum range, if it has one.
    pub(crate) range_m: Option<f64>,
    pub(crate) facts: &'static KindFacts,
    pub(crate) measure: Measure,
}

impl Sensor {
    pub(crate) fn new(spec: &SensorSpec, context: &SensorContext, step_s: f64) -> Self {
        Self {
            name: context.name.to_owned(),
            schedule: Schedule::new(spec.rate_hz, step_s),
            latency_steps: steps_of(spec.latency_s, step_s),
            dropout_probability: spec.dropout_probability,
            power_w: spec.power_w,
            range_m: spec.measures.range_m(),
            facts: spec.measures.facts(),
            measure: spec.measures.measure(context),
        }
    }

    /// Whether a measurement of one step is of use in a later one.
    pub(crate) fn outlasts_a_step(&self) -> bool {
        self.facts.detects || !self.is_immediate()
    }

    /// Whether each measurement is of the step in which the robot has it. After a dropout, the robot
    /// still has the values of an earlier step.
    pub(crate) fn is_immediate(&self) -> bool {
        let repeats = self.dropout_probability > 0.0 && !self.facts.detects;
        self.latency_steps == 0 && self.schedule.is_every_step() && !repeats
    }

    /// Whether the robot has a measurement in the step in which it is taken.
    pub(crate) fn delivers_at_once(&self) -> bool {
        self.is_immediate() || (self.latency_steps == 0 && self.facts.detects)
    }

    /// Whether a measurement yields nothing at all.
    #[inline]
    pub(crate) fn is_dropped(&self, frame: &SensorFrame) -> bool {
        let probability = self.dropout_probability;
        probability > 0.0 && share(frame.words(NoisePurpose::DropOut, 0)[0]) < probability
    }

    /// The range at which it provides something; 0 if it does not.
    pub(crate) fn reach_m(&self, what: Provides) -> f64 {
        let range_m = self.range_m.filter(|_| self.facts.provides(what));
        range_m.unwrap_or(0.0)
    }
}
