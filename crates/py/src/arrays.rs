//! Percepts and commands of all robots of a kind as arrays, with one entry per robot; messages are dicts.

use crate::columns::{self, Given, Shape};
use crate::convert;
use crate::error::input_error;
use crate::message_check::{Kinds, tools_of};
use base::error::{InputError, InputErrors};
use brain::{Command, Percept, ReceivedMessage};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList};
use serde::Deserialize;
use serde_json::Value as Json;
use sim::scenario::Scenario;
use sim::step::PendingDecision;
use std::sync::LazyLock;

/// The columns of percepts. Robots of a kind share some keys, and have as many scans of as many rays.
static PERCEPT: LazyLock<Shape> =
    LazyLock::new(|| Shape::of::<Percept>(&["time_s", "id", "team_size", "scans", "inbox"]));

static COMMAND: LazyLock<Shape> = LazyLock::new(|| Shape::of::<Command>(&["outbox"]));

/// The percepts of the robots of a kind, in columns.
pub(crate) fn percepts<'py>(
    py: Python<'py>,
    decisions: &[PendingDecision],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let time_s = decisions.first().and_then(|first| first.percept.time_s);
    dict.set_item("time_s", time_s.unwrap_or_default())?;
    let indices = decisions
        .iter()
        .map(|decision| i64::from(decision.robot.index));
    let indices: Vec<i64> = indices.collect();
    dict.set_item("robots", indices.into_pyarray(py))?;
    dict.set_item("scans", scans(py, decisions)?)?;
    dict.set_item("inbox", Inbox::of(decisions))?;
    let percepts = decisions.iter().map(|decision| &decision.percept);
    columns::write(&PERCEPT, percepts)?.put_into(&dict)?;
    Ok(dict)
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
        dict.set_item("age_s", ages.collect::<Vec<f64>>().into_pyarray(py))?;
        dict.set_item("ranges_m", ranges_m)?;
        Ok(dict)
    };
    PyList::new(py, (0..rings).map(scan).collect::<PyResult<Vec<_>>>()?)
}

/// The messages that robots have received, each with the `row` of its receiver. They become dicts when they
/// are read: brains may read few of them.
#[pyclass(frozen, sequence)]
struct Inbox(Vec<(usize, ReceivedMessage)>);

impl Inbox {
    fn of(decisions: &[PendingDecision]) -> Self {
        let rows = decisions.iter().enumerate();
        let received = rows.flat_map(|(row, decision)| {
            let inbox = decision.percept.inbox.iter();
            inbox.map(move |received| (row, *received))
        });
        Self(received.collect())
    }
}

#[pymethods]
impl Inbox {
    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __getitem__<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let no_message = || PyIndexError::new_err("no such message");
        let (row, received) = self.0.get(index).ok_or_else(no_message)?;
        let dict = convert::write(py, received)?;
        dict.set_item("row", row)?;
        Ok(dict)
    }
}

/// Sets the commands of robots from columns, and their messages from dicts; `at` is their path in errors.
pub(crate) fn command(
    at: &str,
    scenario: &Scenario,
    returned: &Bound<PyAny>,
    decisions: &mut [PendingDecision],
) -> PyResult<()> {
    let given = Given::read(&COMMAND, at, returned, decisions.len())?;
    let kinds = Kinds::of_scenario(scenario);
    for (entry, decision) in decisions.iter_mut().enumerate() {
        let read = Command::deserialize(given.cell(entry));
        // A second time, for an error in the words of the schema.
        let read = read.or_else(|_| {
            let json = Json::deserialize(given.cell(entry)).unwrap_or_default();
            convert::read_json("", &json)
        });
        let tools = tools_of(scenario, decision.robot.kind);
        let read = read.and_then(|command| kinds.command("", tools, command));
        decision.command = read.map_err(|error| {
            let keys = error
                .path
                .split(['.', '[', ']'])
                .filter(|key| !key.is_empty());
            let path = format!("{at}{}", given.path(entry, keys));
            as_error(InputError { path, ..error })
        })?;
    }
    match returned.cast::<PyDict>()?.get_item("outbox")? {
        Some(outbox) => send(&format!("{at}.outbox"), &kinds, &outbox, decisions),
        None => Ok(()),
    }
}

/// Adds messages to the commands of the robots that send them.
fn send(
    at: &str,
    kinds: &Kinds,
    outbox: &Bound<PyAny>,
    decisions: &mut [PendingDecision],
) -> PyResult<()> {
    let refused = |path: &str, given: &Bound<PyAny>, allowed: &str| {
        let given = given.repr().map(|given| given.to_string());
        let error = InputError::new(path.to_owned(), given.ok(), allowed.to_owned());
        as_error(error)
    };
    let items = outbox.cast::<PyList>();
    let items = items.map_err(|_| refused(at, outbox, "a list of dicts, one for each message"))?;
    let max = decisions.len().saturating_sub(1);
    let allowed_row = format!("a whole number from 0 to {max}, the row of the sender");
    for (number, item) in items.iter().enumerate() {
        let at = format!("{at}[{number}]");
        let dict = item.cast::<PyDict>();
        let dict = dict.map_err(|_| refused(&at, &item, "a dict with row, about, confidence"))?;
        let row = dict.get_item("row")?;
        let row = row.unwrap_or_else(|| item.py().None().into_bound(item.py()));
        let is_whole = !row.is_instance_of::<PyBool>();
        let found = row.extract::<usize>().ok().filter(|_| is_whole);
        let decision = found.and_then(|row| decisions.get_mut(row));
        let Some(decision) = decision else {
            return Err(refused(&format!("{at}.row"), &row, &allowed_row));
        };
        let content = dict.copy()?;
        content.del_item("row")?;
        let message = convert::read(&at, &content).map_err(as_error)?;
        kinds
            .message(&at, &message)
            .map_or(Ok(()), |error| Err(as_error(error)))?;
        decision.command.outbox.push(message);
    }
    Ok(())
}

fn as_error(error: InputError) -> PyErr {
    input_error(&InputErrors(vec![error]), "")
}
