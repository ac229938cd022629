//! Faults become one Python exception.

use base::fault::{Fault, Faults};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

create_exception!(
    agent_economy,
    InputError,
    PyValueError,
    "Something given is not allowed; the message names each value, what is allowed and the fix. \
     `faults` are the same, each a dict, of a scenario or a call; else it is empty."
);

create_exception!(
    agent_economy,
    NoRoomError,
    InputError,
    "The world of a run has no room for its team or its items: another run's may have."
);

/// All faults in one exception, one a line; `file` is what was read, if it was one.
pub(crate) fn input_error(faults: &Faults, file: &str) -> PyErr {
    noted(InputError::new_err(faults.to_string()), faults, file)
}

/// That a run has no room for something.
pub(crate) fn no_room_error(faults: &Faults) -> PyErr {
    noted(NoRoomError::new_err(faults.to_string()), faults, "")
}

fn noted(error: PyErr, faults: &Faults, file: &str) -> PyErr {
    Python::attach(|py| {
        let dicts: PyResult<Vec<_>> = faults
            .0
            .iter()
            .map(|each| as_dict(py, each, file))
            .collect();
        let noted = dicts.and_then(|dicts| error.value(py).setattr("faults", dicts));
        noted.err().unwrap_or(error)
    })
}

fn as_dict<'py>(py: Python<'py>, fault: &Fault, file: &str) -> PyResult<Bound<'py, PyDict>> {
    let place = fault.place(file);
    let dict = PyDict::new(py);
    dict.set_item("origin", &fault.origin)?;
    dict.set_item("file", place.map(|(file, _)| file))?;
    dict.set_item("line", place.and_then(|(_, line)| line))?;
    dict.set_item("path", &fault.path)?;
    dict.set_item("given", &fault.given)?;
    dict.set_item("allowed", &fault.allowed)?;
    dict.set_item("suggestion", &fault.suggestion)?;
    dict.set_item("message", fault.to_string())?;
    Ok(dict)
}
