//! Faults become one Python exception.

use base::fault::{Fault, Faults};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

create_exception!(
    agent_economy,
    InputError,
    PyValueError,
    "Something given is not allowed; the message names each value, what is allowed and the fix."
);

/// All faults in one exception, one a line.
pub(crate) fn input_error(faults: &Faults) -> PyErr {
    InputError::new_err(faults.to_string())
}

/// A fault of an argument: `given` is not what is `allowed`.
pub(crate) fn argument_fault(path: &str, given: &Bound<PyAny>, allowed: String) -> Fault {
    let given = given
        .repr()
        .map_or_else(|_| "?".to_owned(), |repr| repr.to_string());
    Fault {
        origin: None,
        path: path.to_owned(),
        given: Some(given),
        allowed,
        suggestion: None,
    }
}
