//! Scenarios of the classic engine.

use crate::error::{InputError, input_error};
use base::document::{Node, Table, Value};
use classic::Contact;
use classic::scenario::{Factor, Merit, Override, Published, Scenario, Values};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList};

/// Changes as Python gives them: (path, value, origin).
pub(crate) type GivenOverride<'py> = (Vec<String>, Bound<'py, PyAny>, String);

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
    let scenario = Scenario::read(file, text, &given_overrides(overrides)?)
        .map_err(|faults| input_error(&faults))?;
    as_dict(py, &scenario)
}

pub(crate) fn given_overrides(overrides: Vec<GivenOverride>) -> PyResult<Vec<Override>> {
    overrides
        .into_iter()
        .map(|(path, given, origin)| {
            Ok(Override {
                value: value(&path, &given, &origin)?,
                path,
                origin,
            })
        })
        .collect()
}

fn value(path: &[String], given: &Bound<PyAny>, origin: &str) -> PyResult<Value> {
    if let Ok(boolean) = given.cast::<PyBool>() {
        return Ok(Value::Bool(boolean.is_true()));
    }
    if let Ok(text) = given.extract::<String>() {
        return Ok(Value::Text(text));
    }
    if let Ok(number) = given.extract::<i64>() {
        return Ok(Value::Integer(number));
    }
    if let Ok(dict) = given.cast::<PyDict>() {
        return table(path, dict, origin);
    }
    given.extract::<f64>().map(Value::Float).map_err(|_| {
        let path = path.join(".");
        InputError::new_err(format!(
            "{path} = {given}: must be a text, a number or a dict of these"
        ))
    })
}

fn table(path: &[String], dict: &Bound<PyDict>, origin: &str) -> PyResult<Value> {
    let mut table = Table::new();
    for (key, given) in dict {
        let key = key.str()?.to_string();
        let inner: Vec<String> = path.iter().chain([&key]).cloned().collect();
        let node = Node {
            value: value(&inner, &given, origin)?,
            origin: origin.to_owned(),
        };
        table.insert(key, node);
    }
    Ok(Value::Table(table))
}

fn as_dict<'py>(py: Python<'py>, scenario: &Scenario) -> PyResult<Bound<'py, PyDict>> {
    let name = |contact| Contact::NAMES.iter().find(|(_, known)| *known == contact);
    let configuration = &scenario.configuration;
    let dict = PyDict::new(py);
    dict.set_item("summary", &scenario.summary)?;
    let contact = name(configuration.task.contact).map(|(name, _)| *name);
    dict.set_item("contact", contact)?;
    dict.set_item("merit", merit_dict(py, &scenario.merit)?)?;
    dict.set_item("paints_per_s", configuration.clock.paints_per_s)?;
    dict.set_item("cap_s", configuration.clock.cap_s)?;
    dict.set_item("cap_paints", configuration.task.cap_paints)?;
    dict.set_item("robots", configuration.robots)?;
    dict.set_item("factors", factor_dicts(py, &scenario.study.factors)?)?;
    dict.set_item("design", scenario.study.design.to_string())?;
    dict.set_item("delta", scenario.study.delta)?;
    dict.set_item("confidence", scenario.study.confidence)?;
    let published = scenario
        .published
        .as_ref()
        .map(|published| published_dict(py, published));
    dict.set_item("published", published.transpose()?)?;
    Ok(dict)
}

/// `terms` are (name, column, weight, max or None).
fn merit_dict<'py>(py: Python<'py>, merit: &Merit) -> PyResult<Bound<'py, PyDict>> {
    let terms = merit.terms.iter();
    let terms: Vec<_> = terms
        .map(|term| (term.name, term.column, term.weight, term.max))
        .collect();
    let dict = PyDict::new(py);
    dict.set_item("name", merit.name)?;
    dict.set_item("terms", terms)?;
    Ok(dict)
}

/// Each with `path`, `values` (a list; empty for a range) and `range` ((low, high) or None).
fn factor_dicts<'py>(py: Python<'py>, factors: &[Factor]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let factor = |factor: &Factor| {
        let values = PyList::empty(py);
        let mut range = None;
        match &factor.values {
            Values::Between(low, high) => range = Some((*low, *high)),
            Values::Listed(listed) => {
                for value in listed {
                    append(&values, value)?;
                }
            }
        }
        let dict = PyDict::new(py);
        dict.set_item("path", factor.path)?;
        dict.set_item("values", values)?;
        dict.set_item("range", range)?;
        Ok(dict)
    };
    factors.iter().map(factor).collect()
}

fn append(values: &Bound<PyList>, value: &Value) -> PyResult<()> {
    match value {
        Value::Integer(number) => values.append(number),
        Value::Float(number) => values.append(number),
        other => values.append(match other {
            Value::Text(text) => text.clone(),
            other => other.to_string(),
        }),
    }
}

fn published_dict<'py>(py: Python<'py>, published: &Published) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("source", &published.source)?;
    dict.set_item("choice", published.choice)?;
    dict.set_item("cap_s", published.cap_s)?;
    dict.set_item("times_s", published.times_s.clone())?;
    Ok(dict)
}
