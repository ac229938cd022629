//! Checks of arguments of Python functions: all errors of a call in one exception.

use crate::error::input_error;
use base::error::{InputError, InputErrors};
use pyo3::exceptions::PyBaseException;
use pyo3::prelude::*;
use pyo3::types::PyBool;
use std::cell::RefCell;
use std::ops::RangeInclusive;

/// Maximum runs of one call, over all configurations: about half a gigabyte of outcomes.
pub(crate) const MAX_RUNS: u64 = 10_000_000;

/// Collects the errors of the arguments of a call.
#[derive(Default)]
pub(crate) struct Arguments {
    errors: RefCell<Vec<InputError>>,
}

impl Arguments {
    /// A Python int (not a bool) in `range`.
    pub(crate) fn integer(
        &self,
        name: &str,
        given: &Bound<PyAny>,
        range: RangeInclusive<u64>,
    ) -> Option<u64> {
        let number = (!given.is_instance_of::<PyBool>()).then(|| given.extract::<u64>().ok());
        let number = number.flatten().filter(|number| range.contains(number));
        if number.is_none() {
            let allowed = format!("a whole number from {} to {}", range.start(), range.end());
            self.error(name, given, allowed);
        }
        number
    }

    /// A Python number (not a bool) in `range`, in a unit.
    pub(crate) fn number(
        &self,
        name: &str,
        given: &Bound<PyAny>,
        (range, unit): (RangeInclusive<f64>, &str),
    ) -> Option<f64> {
        let number = (!given.is_instance_of::<PyBool>()).then(|| given.extract::<f64>().ok());
        let number = number.flatten().filter(|number| range.contains(number));
        if number.is_none() {
            let allowed = format!(
                "a number from {} to {} ({unit})",
                range.start(),
                range.end()
            );
            self.error(name, given, allowed);
        }
        number
    }

    /// The seed of all random numbers.
    pub(crate) fn seed(&self, given: &Bound<PyAny>) -> Option<u64> {
        self.integer("seed", given, 0..=u64::MAX)
    }

    /// The number of a run. Tables store it as a signed 64-bit integer.
    pub(crate) fn run(&self, name: &str, given: &Bound<PyAny>) -> Option<u64> {
        self.integer(name, given, 0..=i64::MAX.cast_unsigned() - MAX_RUNS)
    }

    /// Number of threads; `Some(None)` for one per processor.
    #[expect(
        clippy::option_option,
        reason = "an error, Python's None, and a number"
    )]
    pub(crate) fn threads(&self, given: &Bound<PyAny>) -> Option<Option<usize>> {
        if given.is_none() {
            return Some(None);
        }
        let threads = self.integer("threads", given, 1..=1024)?;
        usize::try_from(threads).ok().map(Some)
    }

    /// Records that `given` is not what is `allowed`.
    pub(crate) fn error(&self, path: &str, given: &Bound<PyAny>, allowed: String) {
        let error = InputError::new(path.to_owned(), Some(shown(given)), allowed);
        self.errors.borrow_mut().push(error);
    }

    /// `value`, or an exception with all errors.
    pub(crate) fn or_errors<T>(self, value: Option<T>) -> PyResult<T> {
        InputErrors::or(self.errors.into_inner(), value).map_err(|errors| input_error(&errors, ""))
    }
}

/// The exception for an argument that is not what is `allowed`.
#[pyfunction]
pub(crate) fn refusal<'py>(
    name: &str,
    given: &Bound<'py, PyAny>,
    allowed: String,
) -> Bound<'py, PyBaseException> {
    let check = Arguments::default();
    check.error(name, given, allowed);
    let error = input_error(&InputErrors(check.errors.into_inner()), "");
    error.into_value(given.py()).into_bound(given.py())
}

/// The representation of a Python value.
fn shown(given: &Bound<PyAny>) -> String {
    let repr = given.repr().map(|repr| repr.to_string());
    repr.unwrap_or_else(|_| "something that cannot be shown".to_owned())
}
