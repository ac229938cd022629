//! A body that something outside of the simulation moves: where it is, as far as that is known.

use super::kind::Kind;
use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{Body, Motion, Percept, Pose, PoseTracker};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A command counts as executed for this number of periods of the brain. A robot whose percepts end has
/// been stopped.
const MAX_PERIODS: f64 = 2.0;

/// How a body is external.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ExternalSpec {
    /// Where the readings of its sensors come from, by name. Those of other sensors come with its percepts.
    pub sensors: BTreeMap<String, ReadingSource>,
    /// Age of its last position, in seconds, from which on it counts as silent; `None` if it never does.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub max_age_s: Option<f64>,
    /// Corners of the area that it cannot leave, in order; empty if it can be anywhere.
    pub fence_m: Vec<Point>,
}

/// Where the readings of a sensor of an external body come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReadingSource {
    /// Its percepts.
    Real,
    /// The simulation, which measures from where the body is believed to be.
    Virtual,
    /// Both: the nearer range, all contacts, all neighbours.
    Both,
}

/// An external body.
#[derive(Debug, Clone)]
pub(crate) struct ExternalBody {
    pub(crate) spec: Arc<ExternalSpec>,
    /// A bit for each sensor that the simulation measures for it.
    pub(crate) virtual_sensors: u32,
    /// A bit for each sensor whose readings come with its percepts.
    pub(crate) real_sensors: u32,
    tracker: PoseTracker,
    /// Time since its last percept.
    since_s: f64,
    /// Whether it is where something else is.
    pub(crate) is_in_contact: bool,
    /// Its pose now, if known.
    pub(crate) pose: Option<Pose>,
    /// Age of its newest position; `None` before the first one.
    pub(crate) age_s: Option<f64>,
}

impl Hashed for ExternalBody {
    /// The pose follows from the others. Ages matter only for a body that can be silent.
    fn add_to(&self, hash: &mut Hash) {
        self.tracker.add_to(hash);
        self.since_s.add_to(hash);
        self.is_in_contact.add_to(hash);
        if self.spec.max_age_s.is_some() {
            self.age_s.add_to(hash);
        }
    }
}

impl ExternalBody {
    /// A body of a kind without a percept.
    pub(crate) fn new(spec: Arc<ExternalSpec>, kind: &Kind) -> Self {
        let mut body = Self {
            spec,
            virtual_sensors: 0,
            real_sensors: 0,
            tracker: PoseTracker::default(),
            since_s: 0.0,
            is_in_contact: false,
            pose: None,
            age_s: None,
        };
        body.number_sensors(kind);
        body
    }

    /// Finds its sensors among those of its kind, which may have changed.
    pub(crate) fn number_sensors(&mut self, kind: &Kind) {
        (self.virtual_sensors, self.real_sensors) = (0, 0);
        for (number, sensor) in kind.sensors.iter().enumerate() {
            let source = self.spec.sensors.get(&sensor.name);
            let source = source.unwrap_or(&ReadingSource::Real);
            self.virtual_sensors |= u32::from(*source != ReadingSource::Real) << number;
            self.real_sensors |= u32::from(*source != ReadingSource::Virtual) << number;
        }
    }

    /// Takes a percept, or lets time pass without one.
    pub(crate) fn observe(&mut self, percept: Option<&Percept>, elapsed_s: f64, body: &Body) {
        let read_s = percept.and_then(|percept| Some(percept.position?.age_s));
        self.age_s = read_s.or(self.age_s.map(|age_s| age_s + elapsed_s));
        match percept {
            Some(percept) => {
                self.tracker.observe(percept, body);
                self.since_s = 0.0;
            }
            None => self.since_s += elapsed_s,
        }
        let moving_s = self.since_s.min(MAX_PERIODS * body.period_s);
        self.pose = self.tracker.pose_after(moving_s, body);
    }

    /// Takes the motion that is commanded from the last percept on.
    pub(crate) fn command(&mut self, motion: Motion) {
        self.tracker.command(motion);
    }

    /// Age of its newest position if that is too old: then it may have moved at any speed since.
    pub(crate) fn silent_s(&self) -> Option<f64> {
        let max_age_s = self.spec.max_age_s?;
        self.age_s.filter(|age_s| *age_s > max_age_s)
    }

    /// The standard deviation of its position, along each axis.
    pub(crate) fn uncertainty_m(&self, body: &Body) -> f64 {
        let pose = self.pose.as_ref();
        pose.map_or(body.position_error_m(), |pose| pose.deviation_m)
    }

    /// Its speed now, in m/s; negative in reverse.
    pub(crate) fn speed_m_s(&self, body: &Body) -> f64 {
        if self.since_s > MAX_PERIODS * body.period_s {
            0.0
        } else {
            self.tracker.speed_m_s()
        }
    }
}
