//! The errors of messages of the page that cannot be decoded.

use crate::brain::checked;
use crate::error::input_error;
use base::error::InputErrors;
use protocol::{
    Acknowledge, Change, Chart, ChooseVersion, Empty, Open, Play, Seek, Select, SeriesRequest,
    Show, Step,
};
use pyo3::prelude::*;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;

/// Raises the errors of a message of the page, which is a dict without its `type`.
#[pyfunction]
pub(crate) fn check_page_message(kind: &str, message: &Bound<PyAny>) -> PyResult<()> {
    match kind {
        "open" => check::<Open>(kind, message),
        "play" => check::<Play>(kind, message),
        "step" => check::<Step>(kind, message),
        "seek" => check::<Seek>(kind, message),
        "change" => check::<Change>(kind, message),
        "choose_version" => check::<ChooseVersion>(kind, message),
        "chart" => check::<Chart>(kind, message),
        "request_series" => check::<SeriesRequest>(kind, message),
        "select" => check::<Select>(kind, message),
        "show" => check::<Show>(kind, message),
        "acknowledge" => check::<Acknowledge>(kind, message),
        _ => check::<Empty>(kind, message),
    }
}

fn check<T: DeserializeOwned + JsonSchema>(kind: &str, message: &Bound<PyAny>) -> PyResult<()> {
    let read = checked::<T>(kind, message)?;
    read.map(drop)
        .map_err(|errors| input_error(&InputErrors(errors), ""))
}
