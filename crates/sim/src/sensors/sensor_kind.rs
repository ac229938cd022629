//! The interface of a kind of sensor: its specification in scenarios, and its instrument in runs.

use super::buffers::Buffers;
use super::detection_sink::DetectionSink;
use super::outline::Outline;
use super::scene::Scene;
use super::sensor_frame::SensorFrame;
use base::document::Place;
use base::error::InputError;
use brain::{Body, Detector, Percept};

/// What sensors provide: checks require these, and name no kinds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Provides {
    /// Distances along rays.
    Distances,
    Items,
    Robots,
    /// The position of the robot.
    Position,
    /// The heading of the robot.
    Heading,
}

/// The keys of a sensor of one kind, as scenarios give them.
pub(crate) trait SensorKind {
    /// The same, converted for measurements.
    type Instrument: Instrument;

    /// What it provides. [`SensorKind::range_m`] is the range of all of this.
    const PROVIDES: &'static [Provides];

    /// An example in a scenario, for messages about robots that lack such a sensor.
    const EXAMPLE: &'static str;

    /// Whether controllers may have it. Theirs cast no rays, and store no values.
    const FOR_CONTROLLERS: bool = false;

    /// Converts it. Called once per sensor when a scenario is read, after [`SensorKind::errors`]
    /// has found none.
    fn instrument(&self, context: &SensorContext) -> Self::Instrument;

    /// Maximum range, of the key `range_m`; `None` if it measures only the robot itself. Called
    /// when a scenario is read: neighbour lists, indices and the minimum size of a periodic world
    /// follow from it.
    fn range_m(&self) -> Option<f64> {
        None
    }

    /// Adds what the brain of the robot knows of it. Called once per sensor, in their order, when
    /// a scenario is read.
    fn extend_body(&self, _context: &SensorContext, _body: &mut Body) {}

    /// What the brains of all robots know of it as a detector of items. Called like
    /// [`SensorKind::extend_body`], and for the robots that may meet it.
    fn detector(&self, _context: &SensorContext) -> Option<Detector> {
        None
    }

    /// Mean numbers of what one measurement yields, for measurements every `period_s`. Called by
    /// the check that a run fits into memory.
    fn amounts(&self, period_s: f64, around: &impl Vicinity) -> Amounts;

    /// Errors that the ranges of its keys do not exclude, at its place in a document. Called when
    /// a scenario is read.
    fn errors(&self, _context: &SensorContext, _at: &Place) -> Vec<InputError> {
        Vec::new()
    }
}

/// A sensor, converted for measurements.
///
/// It either detects things, or measures values that the next measurement replaces.
pub(crate) trait Instrument {
    /// Whether it detects things: entries that all count.
    const DETECTS: bool = false;

    /// Whether it is a range ring: [`SensorKind::extend_body`] adds one to the body, and it has a
    /// scan in percepts.
    const IS_RING: bool = false;

    /// Takes a measurement. Called in each step in which one is due, unless it is dropped.
    /// Detections go to `sink`, values replace `buffers.values`.
    fn measure(
        &self,
        frame: &SensorFrame,
        scene: &impl Scene,
        buffers: &mut Buffers,
        sink: &mut impl DetectionSink,
    );

    /// Writes the values of a measurement of this age into the percept; `ring` is its number among
    /// the range rings. Called with each measurement that reaches the brain, if it measures values.
    fn write(&self, _percept: &mut Percept, _ring: usize, _age_s: f64, _values: &mut Vec<f64>) {}

    /// The area that it covers, for display. Called when a page requests footprints.
    fn outline(&self) -> Option<Outline> {
        None
    }
}

/// What a sensor depends on besides its own keys.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorContext<'a> {
    /// The robot or controller kind that has it.
    pub(crate) owner: &'a str,
    pub(crate) name: &'a str,
    /// Its number among the sensors of its owner.
    pub(crate) number: u16,
    pub(crate) item_kinds: &'a [String],
    /// Time between two measurements.
    pub(crate) period_s: f64,
    /// Time from a measurement until the robot has it.
    pub(crate) latency_s: f64,
}

/// What is to be expected around a sensor: mean numbers, where everything starts.
pub(crate) trait Vicinity {
    /// Items of each kind within an area.
    fn items_within(&self, area_m2: f64) -> impl Iterator<Item = (&str, f64)>;

    /// Robots within a range.
    fn robots_within(&self, range_m: f64) -> f64;
}

/// Mean numbers of what one measurement yields.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Amounts {
    pub(crate) values: f64,
    pub(crate) observations: f64,
    pub(crate) contacts: f64,
    pub(crate) neighbours: f64,
}

/// What is the same for all sensors of a kind.
#[derive(Debug, PartialEq, Eq)]
pub struct KindFacts {
    /// Its name in scenarios.
    pub name: &'static str,
    pub(crate) provides: &'static [Provides],
    pub(crate) example: &'static str,
    pub(crate) is_for_controllers: bool,
    pub(crate) detects: bool,
    /// Whether it is a ring of rays.
    pub is_ring: bool,
}

impl KindFacts {
    pub(crate) const fn of<K: SensorKind>(name: &'static str) -> Self {
        Self {
            name,
            provides: K::PROVIDES,
            example: K::EXAMPLE,
            is_for_controllers: K::FOR_CONTROLLERS,
            detects: K::Instrument::DETECTS,
            is_ring: K::Instrument::IS_RING,
        }
    }

    pub(crate) fn provides(&self, what: Provides) -> bool {
        self.provides.contains(&what)
    }

    /// Whether it states where the robot is: virtual sensors measure from there.
    #[must_use]
    pub fn states_pose(&self) -> bool {
        self.provides(Provides::Position) || self.provides(Provides::Heading)
    }

    /// Whether the readings of a real and of a virtual one make one reading: the nearer range of each ray, or
    /// all detections.
    #[must_use]
    pub fn can_be_both(&self) -> bool {
        self.detects || self.is_ring
    }

    /// Whether both state the same of the robot.
    pub(crate) fn provides_same(&self, other: &Self) -> bool {
        self.provides.iter().any(|what| other.provides(*what))
    }
}

/// Typed access to one kind among all, for code that is about that kind.
pub(crate) trait AmongKinds<All> {
    /// `all` as this kind; `None` if it is another.
    fn of(all: &All) -> Option<&Self>;

    /// The same, to change it.
    fn of_mut(all: &mut All) -> Option<&mut Self>;
}
