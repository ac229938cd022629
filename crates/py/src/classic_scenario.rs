//! Scenarios of the classic engine.

use crate::error::{InputError, input_error};
use base::document::Value;
use classic::Contact;
use classic::scenario::{Override, Published, Scenario};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};

type GivenOverride<'py> = (Vec<String>, Bound<'py, PyAny>, String);

/// The scenario of a TOML text, as a dict that `agent_economy.scenario` makes typed.
///
/// `overrides` are (path, value, origin): `value` is put at `path` over what the text says, and
/// `origin` is how faults name it.
#[pyfunction]
#[pyo3(signature = (file, text, overrides))]
pub(crate) fn read_scenario<'py>(
    py: Python<'py>,
    file: &str,
    text: &str,
    overrides: Vec<GivenOverride<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let overrides: PyResult<Vec<Override>> = overrides.into_iter().map(given_override).collect();
    let scenario =
        Scenario::read(file, text, &overrides?).map_err(|faults| input_error(&faults))?;
    as_dict(py, &scenario)
}

fn given_override((path, given, origin): GivenOverride) -> PyResult<Override> {
    Ok(Override {
        value: value(&path, &given)?,
        path,
        origin,
    })
}

fn value(path: &[String], given: &Bound<PyAny>) -> PyResult<Value> {
    if let Ok(boolean) = given.cast::<PyBool>() {
        return Ok(Value::Bool(boolean.is_true()));
    }
    if let Ok(text) = given.extract::<String>() {
        return Ok(Value::Text(text));
    }
    if let Ok(number) = given.extract::<i64>() {
        return Ok(Value::Integer(number));
    }
    given.extract::<f64>().map(Value::Float).map_err(|_| {
        let path = path.join(".");
        InputError::new_err(format!("{path} = {given}: must be a text or a number"))
    })
}

fn as_dict<'py>(py: Python<'py>, scenario: &Scenario) -> PyResult<Bound<'py, PyDict>> {
    let name = |contact| Contact::NAMES.iter().find(|(_, known)| *known == contact);
    let merit = PyDict::new(py);
    merit.set_item("name", scenario.merit.name)?;
    merit.set_item("time_s", scenario.merit.time_s)?;
    merit.set_item("robots", scenario.merit.robots)?;
    merit.set_item("failed", scenario.merit.failed)?;

    let dict = PyDict::new(py);
    dict.set_item("summary", &scenario.summary)?;
    dict.set_item("contact", name(scenario.contact).map(|(name, _)| *name))?;
    dict.set_item("merit", merit)?;
    dict.set_item("paints_per_s", scenario.clock.paints_per_s)?;
    dict.set_item("cap_s", scenario.clock.cap_s)?;
    dict.set_item("cap_paints", scenario.clock.cap_paints)?;
    dict.set_item("robots", scenario.robots)?;
    dict.set_item("runs", scenario.study.runs)?;
    dict.set_item("team_sizes", &scenario.study.team_sizes)?;
    let published = scenario
        .published
        .as_ref()
        .map(|published| published_dict(py, published));
    dict.set_item("published", published.transpose()?)?;
    Ok(dict)
}

fn published_dict<'py>(py: Python<'py>, published: &Published) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("source", &published.source)?;
    dict.set_item("choice", published.choice)?;
    dict.set_item("cap_s", published.cap_s)?;
    dict.set_item("times_s", published.times_s.clone())?;
    Ok(dict)
}
