//! Faults become one Python exception.

use base::fault::Faults;
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
