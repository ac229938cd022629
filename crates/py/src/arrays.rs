//! Percepts of all robots of a kind as arrays, with one entry per robot.

use base::geometry::Point;
use brain::{
    About, CommitmentStatus, GoalId, Motion, Percept, Provenance, Reading, ReceivedMessage,
};
use numpy::{Element, IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sim::step::PendingDecision;

/// Codes in place of an item kind: messages about their sender, about its goal, orders, and goals of
/// controllers.
pub(crate) const SENDER: i64 = -1;
pub(crate) const GOAL: i64 = -2;
const ORDER: i64 = -3;
const DISPATCH: i64 = -4;

/// Status of a commitment, by its code.
pub(crate) const STATUSES: [CommitmentStatus; 3] = [
    CommitmentStatus::Active,
    CommitmentStatus::Done,
    CommitmentStatus::Released,
];

/// The provenance of messages; a message that is not about an item has its sender as the observer.
fn provenance(entries: &Entries<ReceivedMessage>) -> PyResult<()> {
    let of = |received: &ReceivedMessage| match received.message.about {
        About::Item { provenance, .. } => provenance,
        _ => Provenance {
            observer: received.from,
            ..Provenance::default()
        },
    };
    entries.put("observer_kind", |received| {
        i64::from(of(received).observer.kind)
    })?;
    entries.put("observer_index", |received| {
        i64::from(of(received).observer.index)
    })?;
    entries.put("track_id", |received| i64::from(of(received).track_id))
}

/// The goal ids of messages; zero in a message that is neither about a destination nor an order.
fn goal_ids(entries: &Entries<ReceivedMessage>) -> PyResult<()> {
    let of = |received: &ReceivedMessage| match received.message.about {
        About::Goal { id, .. } | About::Order { goal: id, .. } => id,
        _ => GoalId::default(),
    };
    entries.put("issuer_kind", |received| {
        i64::from(of(received).issuer.kind)
    })?;
    entries.put("issuer_index", |received| {
        i64::from(of(received).issuer.index)
    })?;
    entries.put("goal_number", |received| i64::from(of(received).number))
}

/// The percepts of the robots of a kind, by the fields of a percept; NaN or false marks a missing value.
///
/// Lists of variable length, such as contacts, are concatenated; `row` holds the index of the robot of
/// each entry.
pub(crate) fn percepts<'py>(
    py: Python<'py>,
    decisions: &[PendingDecision],
) -> PyResult<Bound<'py, PyDict>> {
    let fields = PerceptArrays {
        py,
        decisions,
        dict: PyDict::new(py),
    };
    let time_s = decisions.first().and_then(|first| first.percept.time_s);
    let time_s = time_s.unwrap_or_default();
    fields.dict.set_item("time_s", time_s)?;
    let indices = decisions
        .iter()
        .map(|decision| i64::from(decision.robot.index));
    fields.put("robots", array(py, indices))?;
    fields.put(
        "random_words",
        table(
            py,
            decisions
                .iter()
                .map(|decision| decision.percept.random_words),
        )?,
    )?;
    fields.reading("position", |percept| percept.position)?;
    fields.reading("heading_rad", |percept| percept.heading_rad)?;
    fields.reading("motion", |percept| percept.motion)?;
    fields.reading("battery", |percept| percept.battery)?;
    fields.reading("touch", |percept| percept.touch)?;
    fields.put("scans", scans(py, decisions)?)?;
    fields.put("observations", observations(py, decisions)?)?;
    fields.put("contacts", contacts(py, decisions)?)?;
    fields.put("neighbours", neighbours(py, decisions)?)?;
    fields.put("inbox", inbox(py, decisions)?)?;
    Ok(fields.dict)
}

/// The dict of percepts while it is filled.
struct PerceptArrays<'a, 'py> {
    py: Python<'py>,
    decisions: &'a [PendingDecision],
    dict: Bound<'py, PyDict>,
}

impl<'py> PerceptArrays<'_, 'py> {
    fn put(&self, name: &str, what: impl IntoPyObject<'py>) -> PyResult<()> {
        self.dict.set_item(name, what)
    }

    /// Adds a reading of each robot: its `value` and its `age_s`.
    fn reading<T: Value>(
        &self,
        name: &str,
        of: impl Fn(&Percept) -> Option<Reading<T>>,
    ) -> PyResult<()> {
        let readings = self.decisions.iter().map(|decision| of(&decision.percept));
        let readings: Vec<Option<Reading<T>>> = readings.collect();
        let ages = readings
            .iter()
            .map(|reading| reading.as_ref().map_or(f64::NAN, |it| it.age_s));
        let ages = array(self.py, ages);
        let values = readings.into_iter().map(|reading| Some(reading?.value));
        let dict = PyDict::new(self.py);
        dict.set_item("value", T::arrays(self.py, values)?)?;
        dict.set_item("age_s", ages)?;
        self.put(name, dict)
    }
}

/// The value of a reading.
trait Value: Sized {
    /// One entry per robot; a dict if there are several arrays.
    fn arrays(
        py: Python<'_>,
        values: impl Iterator<Item = Option<Self>>,
    ) -> PyResult<Bound<'_, PyAny>>;
}

impl Value for f64 {
    fn arrays(
        py: Python<'_>,
        values: impl Iterator<Item = Option<Self>>,
    ) -> PyResult<Bound<'_, PyAny>> {
        Ok(array(py, values.map(|value| value.unwrap_or(f64::NAN))))
    }
}

impl Value for bool {
    fn arrays(
        py: Python<'_>,
        values: impl Iterator<Item = Option<Self>>,
    ) -> PyResult<Bound<'_, PyAny>> {
        Ok(array(py, values.map(|value| value == Some(true))))
    }
}

impl Value for Point {
    fn arrays(
        py: Python<'_>,
        values: impl Iterator<Item = Option<Self>>,
    ) -> PyResult<Bound<'_, PyAny>> {
        table(
            py,
            values.map(|value| value.map_or([f64::NAN; 2], |at| [at.x, at.y])),
        )
    }
}

impl Value for Motion {
    fn arrays(
        py: Python<'_>,
        values: impl Iterator<Item = Option<Self>>,
    ) -> PyResult<Bound<'_, PyAny>> {
        let parts = values.map(|value| match value {
            Some(motion) => (motion.speed_m_s, motion.turn_rate_rad_s),
            None => (f64::NAN, f64::NAN),
        });
        let (speeds, turns): (Vec<f64>, Vec<f64>) = parts.unzip();
        let dict = PyDict::new(py);
        dict.set_item("speed_m_s", speeds.into_pyarray(py))?;
        dict.set_item("turn_rate_rad_s", turns.into_pyarray(py))?;
        Ok(dict.into_any())
    }
}

fn array<T: Element>(py: Python<'_>, values: impl Iterator<Item = T>) -> Bound<'_, PyAny> {
    values.collect::<Vec<T>>().into_pyarray(py).into_any()
}

fn table<T: Element, const N: usize>(
    py: Python<'_>,
    rows: impl Iterator<Item = [T; N]>,
) -> PyResult<Bound<'_, PyAny>> {
    let rows: Vec<[T; N]> = rows.collect();
    let shape = [rows.len(), N];
    let table = rows.into_flattened().into_pyarray(py).reshape(shape)?;
    Ok(table.into_any())
}

/// `age_s` and `ranges_m` of each ring, with one row per robot.
fn scans<'py>(py: Python<'py>, decisions: &[PendingDecision]) -> PyResult<Bound<'py, PyList>> {
    let rings = decisions
        .first()
        .map_or(0, |first| first.percept.scans.len());
    let scan = |ring: usize| {
        let scans = || {
            decisions
                .iter()
                .filter_map(|decision| decision.percept.scans.get(ring))
        };
        let rays = scans().map(|scan| scan.ranges_m.len()).max().unwrap_or(0);
        let mut ranges_m = Vec::with_capacity(decisions.len() * rays);
        for (row, scan) in scans().enumerate() {
            ranges_m.extend_from_slice(&scan.ranges_m);
            ranges_m.resize((row + 1) * rays, f64::NAN);
        }
        let ranges_m = ranges_m.into_pyarray(py).reshape([decisions.len(), rays])?;
        let dict = PyDict::new(py);
        let ages = scans().map(|scan| scan.age_s.unwrap_or(f64::NAN));
        dict.set_item("age_s", array(py, ages))?;
        dict.set_item("ranges_m", ranges_m)?;
        Ok(dict)
    };
    PyList::new(py, (0..rings).map(scan).collect::<PyResult<Vec<_>>>()?)
}

fn observations<'py>(
    py: Python<'py>,
    decisions: &[PendingDecision],
) -> PyResult<Bound<'py, PyDict>> {
    let entries = Entries::new(py, decisions, |percept| &percept.observations)?;
    entries.put("sensor", |observation| i64::from(observation.sensor))?;
    entries.put("age_s", |observation| observation.age_s)?;
    Ok(entries.dict)
}

fn contacts<'py>(py: Python<'py>, decisions: &[PendingDecision]) -> PyResult<Bound<'py, PyDict>> {
    let entries = Entries::new(py, decisions, |percept| &percept.contacts)?;
    entries.put("kind", |contact| i64::from(contact.kind))?;
    entries.put("sensor", |contact| i64::from(contact.sensor))?;
    entries.put("range_m", |contact| contact.range_m)?;
    entries.put("bearing_rad", |contact| contact.bearing_rad)?;
    entries.put("age_s", |contact| contact.age_s)?;
    Ok(entries.dict)
}

fn neighbours<'py>(py: Python<'py>, decisions: &[PendingDecision]) -> PyResult<Bound<'py, PyDict>> {
    let entries = Entries::new(py, decisions, |percept| &percept.neighbours)?;
    entries.put("range_m", |neighbour| neighbour.range_m)?;
    entries.put("bearing_rad", |neighbour| neighbour.bearing_rad)?;
    entries.put("course_rad", |neighbour| {
        neighbour.course_rad.unwrap_or(f64::NAN)
    })?;
    entries.put("age_s", |neighbour| neighbour.age_s)?;
    entries.put("kind", |neighbour| i64::from(neighbour.id.kind))?;
    entries.put("index", |neighbour| i64::from(neighbour.id.index))?;
    Ok(entries.dict)
}

fn inbox<'py>(py: Python<'py>, decisions: &[PendingDecision]) -> PyResult<Bound<'py, PyDict>> {
    let entries = Entries::new(py, decisions, |percept| &percept.inbox)?;
    entries.put("from_kind", |received| i64::from(received.from.kind))?;
    entries.put("from_index", |received| i64::from(received.from.index))?;
    entries.put("age_s", |received| received.age_s)?;
    entries.put("confidence", |received| received.message.confidence)?;
    entries.put("item_kind", |received| match received.message.about {
        About::Item { kind, .. } => kind.into(),
        About::Sender { .. } => SENDER,
        About::Goal { .. } => GOAL,
        About::Order { .. } => ORDER,
        About::Dispatch(_) => DISPATCH,
    })?;
    entries.put("heading_rad", |received| match received.message.about {
        About::Sender { heading_rad, .. } => heading_rad,
        _ => f64::NAN,
    })?;
    entries.put("observations", |received| match received.message.about {
        About::Item { provenance, .. } => provenance.observations.into(),
        About::Sender { observations, .. } => observations.into(),
        _ => 0_i64,
    })?;
    provenance(&entries)?;
    goal_ids(&entries)?;
    entries.put("status", |received| match received.message.about {
        About::Goal { status, .. } => status as i64,
        About::Order { action, .. } => action as i64,
        _ => 0,
    })?;
    let places = entries
        .all
        .iter()
        .map(|(_, received)| match received.message.about {
            About::Item { at, .. }
            | About::Sender { at, .. }
            | About::Goal { at, .. }
            | About::Order { at, .. } => [at.x, at.y],
            About::Dispatch(dispatch) => {
                let task = dispatch.task();
                task.map_or([f64::NAN; 2], |task| task.at_m.map(f64::from))
            }
        });
    entries.dict.set_item("at", table(py, places)?)?;
    Ok(entries.dict)
}

/// Lists of variable length, concatenated, with the index of the robot of each entry.
struct Entries<'a, 'py, T> {
    py: Python<'py>,
    all: Vec<(i64, &'a T)>,
    dict: Bound<'py, PyDict>,
}

impl<'a, 'py, T> Entries<'a, 'py, T> {
    fn new(
        py: Python<'py>,
        decisions: &'a [PendingDecision],
        of: impl Fn(&'a Percept) -> &'a Vec<T>,
    ) -> PyResult<Self> {
        let robots = (0..).zip(decisions);
        let all = robots
            .flat_map(|(row, decision)| of(&decision.percept).iter().map(move |each| (row, each)));
        let all: Vec<(i64, &T)> = all.collect();
        let dict = PyDict::new(py);
        dict.set_item("row", array(py, all.iter().map(|(row, _)| *row)))?;
        Ok(Self { py, all, dict })
    }

    fn put<N: Element>(&self, name: &str, of: impl Fn(&T) -> N) -> PyResult<()> {
        let values = self.all.iter().map(|(_, each)| of(each));
        self.dict.set_item(name, array(self.py, values))
    }
}
