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
    /// Its newest position, if there was one.
    pub(crate) fix: Option<Point>,
    /// The age of that; before the first one, the time since the body has been external.
    age_s: f64,
    /// Whether nothing is known of its motion, as while a person drives it.
    moves_freely: bool,
    /// Time since the last step of its brain.
    idle_s: f64,
}

impl Hashed for ExternalBody {
    /// The pose follows from the others. Ages matter only for a body that can be silent.
    fn add_to(&self, hash: &mut Hash) {
        self.tracker.add_to(hash);
        self.since_s.add_to(hash);
        self.is_in_contact.add_to(hash);
        if self.spec.max_age_s.is_some() {
            self.age_s.add_to(hash);
            self.moves_freely.add_to(hash);
        }
    }
}

/// What is read of an external body in a step.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Read<'a> {
    Nothing,
    /// A percept from which its brain decides.
    Decides(&'a Percept),
    /// A percept that only states where it is.
    Only(&'a Percept),
}

impl<'a> Read<'a> {
    pub(crate) fn percept(self) -> Option<&'a Percept> {
        match self {
            Self::Nothing => None,
            Self::Decides(percept) | Self::Only(percept) => Some(percept),
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
            fix: None,
            age_s: 0.0,
            moves_freely: false,
            idle_s: 0.0,
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
    pub(crate) fn observe(&mut self, read: Read, elapsed_s: f64, body: &Body) {
        let percept = read.percept();
        let position = percept.and_then(|percept| percept.position);
        // An age from outside can be any number.
        self.age_s = position.map_or(self.age_s + elapsed_s, |position| position.age_s.max(0.0));
        self.fix = position.map(|position| position.value).or(self.fix);
        self.idle_s += elapsed_s;
        match read {
            Read::Nothing => self.since_s += elapsed_s,
            Read::Decides(percept) => {
                self.tracker.observe(percept, body);
                (self.since_s, self.idle_s, self.moves_freely) = (0.0, 0.0, false);
            }
            Read::Only(percept) => {
                // The last command of its brain is not in force any more.
                self.tracker.command(Motion::default());
                self.tracker.observe(percept, body);
                (self.since_s, self.moves_freely) = (0.0, percept.motion.is_none());
            }
        }
        let moving_s = self.since_s.min(MAX_PERIODS * body.period_s);
        self.pose = self.tracker.pose_after(moving_s, body);
    }

    /// Where it is known to have been last, if it may have moved in any way since.
    pub(crate) fn last_place(&self) -> Option<Point> {
        let is_unknown = self.moves_freely || self.silent_s().is_some();
        self.fix.filter(|_| is_unknown)
    }

    /// Whether its brain has not stepped for several periods: it is held, or driven by hand.
    pub(crate) fn is_idle(&self, body: &Body) -> bool {
        self.idle_s > MAX_PERIODS * body.period_s
    }

    /// Takes the motion that is commanded from the last percept on.
    pub(crate) fn command(&mut self, motion: Motion) {
        self.tracker.command(motion);
    }

    /// Age of its newest position if that is too old: then it may have moved at any speed since.
    pub(crate) fn silent_s(&self) -> Option<f64> {
        let max_age_s = self.spec.max_age_s?;
        (self.age_s > max_age_s).then_some(self.age_s)
    }

    /// How far it may be from its position: the standard deviation of that along each axis, and how far it can
    /// have moved in any way since.
    pub(crate) fn uncertainty_m(&self, body: &Body) -> f64 {
        let pose = self.pose.as_ref();
        if self.moves_freely || self.silent_s().is_some() {
            body.position_error_m() + self.age_s * body.max_speed_m_s
        } else {
            pose.map_or(body.position_error_m(), |pose| pose.deviation_m)
        }
    }

    /// Its speed now, in m/s; negative in reverse.
    pub(crate) fn speed_m_s(&self, body: &Body) -> f64 {
        if self.since_s > MAX_PERIODS * body.period_s || self.last_place().is_some() {
            0.0
        } else {
            self.tracker.speed_m_s()
        }
    }
}
