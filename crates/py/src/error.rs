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
    "Something given is not allowed; the message names each value, what is allowed and the fix. \
     `errors` has the same as a list of dicts for a scenario or a call; otherwise it is empty."
);

create_exception!(
    agent_economy,
    NoRoomError,
    InputError,
    "The world of a run has no room for its team or its items: another run's may have."
);

/// All errors in one exception, one a line; `file` is what was read, if it was one.
pub(crate) fn input_error(errors: &InputErrors, file: &str) -> PyErr {
    noted(InputError::new_err(errors.to_string()), errors, file)
}

/// That a run has no room for something.
pub(crate) fn no_room_error(errors: &InputErrors) -> PyErr {
    noted(NoRoomError::new_err(errors.to_string()), errors, "")
}

fn noted(error: PyErr, errors: &InputErrors, file: &str) -> PyErr {
    Python::attach(|py| {
        let dicts: PyResult<Vec<_>> = errors
            .0
            .iter()
            .map(|each| as_dict(py, each, file))
            .collect();
        let noted = dicts.and_then(|dicts| error.value(py).setattr("errors", dicts));
        noted.err().unwrap_or(error)
    })
}

fn as_dict<'py>(
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
