//! The errors of a call or a scenario become one Python exception.

use base::error::{self as input, InputErrors};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

create_exception!(
    agent_economy,
    InputError,
    PyValueError,
    "Invalid input. The message states each value, what is allowed, and a suggestion. \
     `errors` has the same as a list of dicts for a scenario or a call; otherwise it is empty."
);

create_exception!(
    agent_economy,
    NoRoomError,
    InputError,
    "The world of this run has no free place for a robot or an item; other runs may have one."
);

/// All errors in one exception, one per line; `file` is the name of the file that was read, if any.
pub(crate) fn input_error(errors: &InputErrors, file: &str) -> PyErr {
    noted(InputError::new_err(errors.to_string()), errors, file)
}

/// The error that a run has no room for an entity.
pub(crate) fn no_room_error(errors: &InputErrors) -> PyErr {
    noted(NoRoomError::new_err(errors.to_string()), errors, "")
}

fn noted(error: PyErr, errors: &InputErrors, file: &str) -> PyErr {
    Python::attach(|py| {
        let dicts: PyResult<Vec<_>> = errors
            .0
            .iter()
            .map(|each| error_dict(py, each, file))
            .collect();
        let noted = dicts.and_then(|dicts| error.value(py).setattr("errors", dicts));
        noted.err().unwrap_or(error)
    })
}

/// An error as a dict.
pub(crate) fn error_dict<'py>(
    py: Python<'py>,
    error: &input::InputError,
    file: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let place = error.place(file);
    let dict = PyDict::new(py);
    dict.set_item("origin", &error.origin)?;
    dict.set_item("file", place.map(|(file, _)| file))?;
    dict.set_item("line", place.and_then(|(_, line)| line))?;
    dict.set_item("path", &error.path)?;
    dict.set_item("value", error.value())?;
    dict.set_item("allowed", &error.allowed)?;
    dict.set_item("suggestion", &error.suggestion)?;
    dict.set_item("message", error.to_string())?;
    Ok(dict)
}
