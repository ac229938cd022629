//! Converts percepts and commands from and to Python dicts, lists and values.
//!
//! For speed, they are read without a schema, and only the first error is reported.

use crate::serde_error;
use base::document::path_of;
use base::error::InputError;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyComplex, PyDict, PyFloat, PyInt, PyString};
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value as Json};
use serde_path_to_error::{Path, Segment};

/// Maximum nesting depth of lists and dicts; a list that contains itself is deeper.
pub(crate) const MAX_DEPTH: usize = 32;

/// The error that a value is nested too deeply. It has no representation, which Python may not be able to
/// make.
pub(crate) fn too_deep(at: String) -> InputError {
    let allowed = format!("at most {MAX_DEPTH} levels deep; does a list or dict contain itself?");
    InputError::new(at, Some("...".to_owned()), allowed)
}

/// Reads a dict; `at` is its path in errors.
pub(crate) fn read<T: DeserializeOwned + JsonSchema>(
    at: &str,
    given: &Bound<PyAny>,
) -> Result<T, InputError> {
    let json = json(given, MAX_DEPTH).map_err(|error| inside(at, error))?;
    // Serde would accept a list, by position.
    if !json.is_object() {
        return Err(mismatch(at, json.to_string(), "a dict"));
    }
    if let Ok(read) = T::deserialize(&json) {
        return Ok(read);
    }
    // A second time, for the path of the error.
    serde_path_to_error::deserialize(&json).map_err(|refusal| {
        let error = refused::<T>(at, &json, refusal.path());
        // Infinity is read as null, which is not allowed here.
        if is_infinite(given, refusal.path()) {
            let (given, allowed) = (Some("inf".to_owned()), "a finite number".to_owned());
            return InputError::new(error.path, given, allowed);
        }
        error
    })
}

/// Reads JSON; `at` is its path in errors.
pub(crate) fn read_json<T: DeserializeOwned + JsonSchema>(
    at: &str,
    json: &Json,
) -> Result<T, InputError> {
    let read = serde_path_to_error::deserialize(json);
    read.map_err(|refusal| refused::<T>(at, json, refusal.path()))
}

/// The error at a path, where serde failed to read a `T`.
fn refused<T: JsonSchema>(at: &str, json: &Json, path: &Path) -> InputError {
    let error = serde_error::error::<T>(json, path);
    let path = below(at, &error.path);
    InputError { path, ..error }
}

/// Converts a value to Python.
pub(crate) fn write<'py>(py: Python<'py>, object: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    // All keys are strings and all values are JSON values, so it cannot fail.
    as_python(py, &serde_json::to_value(object).unwrap_or_default())
}

pub(crate) fn below(at: &str, path: &str) -> String {
    match path.chars().next() {
        None => at.to_owned(),
        Some('[') => format!("{at}{path}"),
        Some(_) => format!("{at}.{path}"),
    }
}

/// Whether the value at a path is infinite.
fn is_infinite(given: &Bound<PyAny>, path: &Path) -> bool {
    let found = path
        .iter()
        .try_fold(given.clone(), |given, each| match each {
            Segment::Seq { index } => given.get_item(index),
            Segment::Map { key } | Segment::Enum { variant: key } => given.get_item(key),
            Segment::Unknown => Ok(given),
        });
    let number = found.and_then(|found| found.extract::<f64>());
    number.is_ok_and(f64::is_infinite)
}

/// Converts a Python value to JSON; infinity becomes null. `deep` is the remaining depth. The path of an error
/// begins at the value: most values have none.
fn json(given: &Bound<PyAny>, deep: usize) -> Result<Json, InputError> {
    let too_deep = || too_deep(String::new());
    // The types of most values come first: what extracts another one makes an exception of Python if it fails.
    if given.is_none() {
        Ok(Json::Null)
    } else if given.is_instance_of::<PyFloat>() {
        number(given)
    } else if let Some(whole) = given
        .cast_exact::<PyInt>()
        .ok()
        .and_then(|whole| whole.extract::<i64>().ok())
    {
        Ok(Json::from(whole))
    } else if let Ok(truth) = given.extract::<bool>() {
        Ok(Json::Bool(truth))
    } else if let Ok(text) = given.cast::<PyString>() {
        let text = text.extract().map(Json::String);
        text.map_err(|_| mismatch("", given.to_string(), "a string of valid Unicode"))
    } else if let Ok(dict) = given.cast::<PyDict>() {
        let deep = deep.checked_sub(1).ok_or_else(too_deep)?;
        let entry = |(key, given): (Bound<PyAny>, Bound<PyAny>)| {
            let key = text(&key);
            let value = json(&given, deep).map_err(|error| inside(&path_of("", &key), error))?;
            Ok((key, value))
        };
        let entries: Result<Map<String, Json>, InputError> = dict.iter().map(entry).collect();
        entries.map(Json::Object)
    } else if let Ok(items) = given.try_iter() {
        let deep = deep.checked_sub(1).ok_or_else(too_deep)?;
        let item = |(index, item): (usize, PyResult<Bound<PyAny>>)| {
            let item = item.map_err(|error| mismatch("", error.to_string(), "there"));
            let read = item.and_then(|item| json(&item, deep));
            read.map_err(|error| inside(&format!("[{index}]"), error))
        };
        items.enumerate().map(item).collect()
    } else if let Ok(whole) = given.extract::<i64>() {
        Ok(Json::from(whole))
    } else {
        number(given)
    }
}

/// An error of a value inside another one.
fn inside(key: &str, error: InputError) -> InputError {
    InputError {
        path: below(key, &error.path),
        ..error
    }
}

/// A string itself, or the representation of another value. Converting to a representation would
/// swallow Ctrl-C.
pub(crate) fn text(given: &Bound<PyAny>) -> String {
    let text = given.extract::<String>();
    text.unwrap_or_else(|_| given.to_string())
}

fn number(given: &Bound<PyAny>) -> Result<Json, InputError> {
    // numpy would drop the imaginary part.
    let is_complex = given.is_instance_of::<PyComplex>();
    let number = given.extract::<f64>().ok().filter(|_| !is_complex);
    if number == Some(f64::INFINITY) {
        return Ok(Json::Null);
    }
    let number = number.and_then(Number::from_f64).map(Json::Number);
    let allowed = if given.is_instance_of::<PyFloat>() {
        "a finite number; only a ray without a return is inf"
    } else {
        "a number, a string, True, False, None, or a list or dict of these"
    };
    number.ok_or_else(|| mismatch("", given.to_string(), allowed))
}

fn mismatch(at: &str, given: String, allowed: &str) -> InputError {
    InputError::new(at.to_owned(), Some(given), allowed.to_owned())
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
