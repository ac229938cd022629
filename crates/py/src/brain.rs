//! Brains, for whoever has percepts of their own: live robots, other simulators, learning.

use crate::error::input_error;
use crate::scenario::value;
use base::document::schema::Schema;
use base::document::{Document, path_of};
use base::fault::{Fault, Faults};
use brain::{Body, BrainSpec, Command, Percept};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use schemars::{JsonSchema, schema_for};
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value as Json};
use serde_path_to_error::Segment;
use std::sync::{Arc, Mutex, PoisonError};

/// A robot's mind.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct Brain(Mutex<brain::Brain>);

#[pymethods]
impl Brain {
    /// As a scenario's `[robots.KIND.brain]` says, in a body; both are dicts.
    #[new]
    fn new(spec: &Bound<PyAny>, body: &Bound<PyAny>) -> PyResult<Self> {
        let mut faults = Vec::new();
        let spec = read::<BrainSpec>("brain", spec, &mut faults)?;
        let body = read::<Body>("body", body, &mut faults)?;
        let both = spec.zip(body);
        let (spec, body) = Faults::or(faults, both).map_err(|faults| input_error(&faults, ""))?;
        let brain = brain::Brain::new(Arc::new(spec), Arc::new(body));
        Ok(Self(Mutex::new(brain)))
    }

    /// The command for a percept; both are dicts.
    fn step<'py>(&self, percept: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let read = read_percept(percept).map_err(|fault| input_error(&Faults(vec![fault]), ""))?;
        let command = self.with(|brain| brain.step(&read));
        as_python(percept.py(), &as_json(&command))
    }

    /// A brain with the same memories, which then goes its own way.
    fn copy(&self) -> Self {
        Self(Mutex::new(self.with(|brain| brain.clone())))
    }

    /// The JSON Schemas of all that enters and leaves a brain, by name.
    #[staticmethod]
    fn schemas(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let schemas = [
            ("BrainSpec", schema_for!(BrainSpec)),
            ("Body", schema_for!(Body)),
            ("Percept", schema_for!(Percept)),
            ("Command", schema_for!(Command)),
        ];
        let schemas = schemas.map(|(name, schema)| (name.to_owned(), schema.to_value()));
        as_python(py, &Json::Object(schemas.into_iter().collect()))
    }
}

impl Brain {
    fn with<T>(&self, act: impl FnOnce(&mut brain::Brain) -> T) -> T {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// What a dict says that is checked as a document is; `name` is how faults name it.
fn read<T: DeserializeOwned + JsonSchema>(
    name: &str,
    given: &Bound<PyAny>,
    faults: &mut Vec<Fault>,
) -> PyResult<Option<T>> {
    let mut document = Document::parse("", "").map_err(|faults| input_error(&faults, ""))?;
    document.set(&[], value(&[name.to_owned()], given, name)?, "");
    let read = document.typed(&Schema::of::<T>());
    let wrong = read.as_ref().err().into_iter().flat_map(|faults| &faults.0);
    faults.extend(wrong.map(|fault| Fault {
        origin: None,
        path: below(name, &fault.path),
        ..fault.clone()
    }));
    Ok(read.ok())
}

fn below(name: &str, path: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{name}.{path}")
    }
}

/// A percept comes many times a second, so it is read without a schema, up to its first fault.
fn read_percept(given: &Bound<PyAny>) -> Result<Percept, Fault> {
    let json = json("", given)?;
    serde_path_to_error::deserialize(&json).map_err(|error| {
        let path = error.path().to_string();
        let path = if path == "." { "" } else { &path };
        let given = found(&json, error.path().iter()).to_string();
        fault(path, given, format!("readable: {}", error.inner()))
    })
}

/// The innermost value on a path that is there.
fn found<'j, 'p>(json: &'j Json, path: impl Iterator<Item = &'p Segment>) -> &'j Json {
    path.fold(json, |json, segment| {
        let next = match segment {
            Segment::Map { key } => json.get(key),
            Segment::Seq { index } => json.get(index),
            _ => None,
        };
        next.unwrap_or(json)
    })
}

fn fault(path: &str, given: String, allowed: String) -> Fault {
    Fault::new(below("percept", path), Some(given), allowed)
}

/// A Python value as JSON has it: infinity is null.
fn json(path: &str, given: &Bound<PyAny>) -> Result<Json, Fault> {
    if given.is_none() {
        Ok(Json::Null)
    } else if let Ok(truth) = given.extract::<bool>() {
        Ok(Json::Bool(truth))
    } else if let Ok(text) = given.extract::<String>() {
        Ok(Json::String(text))
    } else if let Ok(dict) = given.cast::<PyDict>() {
        let entry = |(key, given): (Bound<PyAny>, Bound<PyAny>)| {
            let key = key.to_string();
            Ok((key.clone(), json(&path_of(path, &key), &given)?))
        };
        let entries: Result<Map<String, Json>, Fault> = dict.iter().map(entry).collect();
        entries.map(Json::Object)
    } else if let Ok(items) = given.try_iter() {
        let item = |(index, item): (usize, PyResult<Bound<PyAny>>)| {
            let path = format!("{path}[{index}]");
            let item = item.map_err(|error| fault(&path, error.to_string(), "there".to_owned()))?;
            json(&path, &item)
        };
        items.enumerate().map(item).collect()
    } else if let Ok(whole) = given.extract::<i64>() {
        Ok(Json::from(whole))
    } else {
        number(path, given)
    }
}

fn number(path: &str, given: &Bound<PyAny>) -> Result<Json, Fault> {
    let number = given.extract::<f64>().ok();
    if number == Some(f64::INFINITY) {
        return Ok(Json::Null);
    }
    let number = number.and_then(Number::from_f64).map(Json::Number);
    let allowed = "a number, a text, true, false, None, or a list or dict of these";
    number.ok_or_else(|| fault(path, given.to_string(), allowed.to_owned()))
}

fn as_json(command: &Command) -> Json {
    // A command holds finite numbers and names only, which JSON has.
    serde_json::to_value(command).unwrap_or_default()
}

fn as_python<'py>(py: Python<'py>, value: &Json) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Json::Null => Ok(py.None().into_bound(py)),
        Json::Bool(truth) => truth.into_bound_py_any(py),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => whole.into_bound_py_any(py),
            None => number.as_f64().into_bound_py_any(py),
        },
        Json::String(text) => text.into_bound_py_any(py),
        Json::Array(items) => {
            let items = items.iter().map(|item| as_python(py, item));
            items.collect::<PyResult<Vec<_>>>()?.into_bound_py_any(py)
        }
        Json::Object(entries) => {
            let dict = PyDict::new(py);
            for (key, value) in entries {
                dict.set_item(key, as_python(py, value)?)?;
            }
            Ok(dict.into_any())
        }
    }
}
