//! Scenarios of every engine.

use crate::convert::{MAX_DEPTH, too_deep, write};
use crate::engines::ENGINES;
use crate::error::input_error;
use base::document::schema::Schema;
use base::document::{Document, Node, Override, Table, Value};
use base::error::{InputError, InputErrors};
use base::scenario::{Factor, Merit, Published, Requirement, Scenario, Values};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use sim::scenario::ScenarioSpec;
use std::collections::BTreeMap;

/// A change from Python: (path, value, origin).
pub(crate) type GivenOverride<'py> = (Vec<String>, Bound<'py, PyAny>, String);

/// The source of a scenario: see `Source` in `agent_economy.scenario`.
///
/// `overrides` are (path, value, origin): `value` replaces the one at `path`, and `origin` is its origin in
/// errors. `files` are those that the text refers to, by name: bytes, or the reason why they cannot be
/// read.
#[derive(FromPyObject)]
pub(crate) struct Source<'py> {
    pub(crate) file: String,
    text: String,
    #[pyo3(attribute("changes"))]
    overrides: Vec<GivenOverride<'py>>,
    files: BTreeMap<String, GivenFile>,
}

#[derive(FromPyObject)]
enum GivenFile {
    Bytes(Vec<u8>),
    Refusal(String),
}

/// Reads the scenario of a source as a dict, which `agent_economy.scenario` converts to types.
#[pyfunction]
pub(crate) fn read_scenario<'py>(
    py: Python<'py>,
    source: Source<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let file = source.file.clone();
    let read = Scenario::read(&ENGINES, source.document()?);
    as_dict(py, &read.map_err(|errors| input_error(&errors, &file))?)
}

/// The files that a source refers to and lacks. Once it has them, it may refer to more.
#[pyfunction]
pub(crate) fn missing_files(source: Source) -> PyResult<Vec<String>> {
    Ok(base::scenario::missing_files(&ENGINES, &source.document()?))
}

/// Quantities that follow from the values of a source, as (name, description); none if it has errors.
#[pyfunction]
pub(crate) fn derived_quantities(
    py: Python<'_>,
    source: Source,
) -> PyResult<Vec<(String, String)>> {
    let document = source.document()?;
    Ok(py.detach(|| base::scenario::derived(&ENGINES, &document)))
}

/// The document of a source, unchecked, as dicts, lists and values.
#[pyfunction]
pub(crate) fn read_document<'py>(
    py: Python<'py>,
    source: Source<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    whole(py, &source.document()?)
}

/// The same, with the defaults of its model in every robot kind.
#[pyfunction]
pub(crate) fn read_filled<'py>(
    py: Python<'py>,
    source: Source<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    whole(py, &ScenarioSpec::filled(&source.document()?))
}

/// The numbers, switches and choices of a valid source under a JSON Schema, as dicts.
#[pyfunction]
pub(crate) fn parameters<'py>(
    py: Python<'py>,
    source: Source<'py>,
    schema: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let schema = serde_json::from_str(schema).map(Schema::for_editors);
    let schema = schema.map_err(|error| PyValueError::new_err(error.to_string()))?;
    write(
        py,
        &schema.parameters(&ScenarioSpec::filled(&source.document()?)),
    )
}

fn whole<'py>(py: Python<'py>, document: &Document) -> PyResult<Bound<'py, PyAny>> {
    document.get(&[]).map_or_else(
        || Ok(PyDict::new(py).into_any()),
        |root| plain(py, &root.value),
    )
}

impl Source<'_> {
    pub(crate) fn document(self) -> PyResult<Document> {
        let parsed = Document::parse(&self.file, &self.text);
        let parsed = parsed.map_err(|errors| input_error(&errors, &self.file))?;
        let overrides = self.overrides.into_iter().map(|(path, given, origin)| {
            Ok(Override {
                value: value(&path, &given, &origin)?,
                path,
                origin,
            })
        });
        let overrides: Vec<Override> = overrides.collect::<PyResult<_>>()?;
        let files = self.files.into_iter().map(|(name, file)| match file {
            GivenFile::Bytes(bytes) => (name, Ok(bytes)),
            GivenFile::Refusal(why) => (name, Err(why)),
        });
        Ok(parsed.with(&overrides).with_files(files.collect()))
    }
}

/// Converts a Python value at `path` to a document value.
pub(crate) fn value(path: &[String], given: &Bound<PyAny>, origin: &str) -> PyResult<Value> {
    let at = At {
        path,
        origin,
        skips_none: false,
    };
    nested(at, given, MAX_DEPTH)
}

/// The same, but None in a dict counts as missing.
pub(crate) fn value_without_none(
    path: &[String],
    given: &Bound<PyAny>,
    origin: &str,
) -> PyResult<Value> {
    let at = At {
        path,
        origin,
        skips_none: true,
    };
    nested(at, given, MAX_DEPTH)
}

/// Converts a value; `deep` is the remaining depth.
fn nested(at: At, given: &Bound<PyAny>, deep: usize) -> PyResult<Value> {
    if let Ok(boolean) = given.cast::<PyBool>() {
        return Ok(Value::Bool(boolean.is_true()));
    }
    if let Ok(text) = given.extract::<String>() {
        return Ok(Value::Text(text));
    }
    if let Ok(number) = given.extract::<i64>() {
        return Ok(Value::Integer(number));
    }
    let too_deep = || refusal(at.origin, too_deep(at.path.join(".")));
    if let Ok(dict) = given.cast::<PyDict>() {
        return table(at, dict, deep.checked_sub(1).ok_or_else(too_deep)?);
    }
    if let Ok(items) = given.extract::<Vec<Bound<PyAny>>>() {
        let deep = deep.checked_sub(1).ok_or_else(too_deep)?;
        let items = items.iter().map(|item| node(at, item, deep));
        return items.collect::<PyResult<_>>().map(Value::List);
    }
    given.extract::<f64>().map(Value::Float).map_err(|_| {
        let allowed = "a string, a number, true, false, or a list or dict of these".to_owned();
        let given = Some(given.to_string());
        refusal(
            at.origin,
            InputError::new(at.path.join("."), given, allowed),
        )
    })
}

/// The path of a value, its origin, and whether None in a dict counts as missing.
#[derive(Clone, Copy)]
struct At<'a> {
    path: &'a [String],
    origin: &'a str,
    skips_none: bool,
}

fn refusal(origin: &str, error: InputError) -> PyErr {
    let origin = Some(origin.to_owned());
    input_error(&InputErrors(vec![InputError { origin, ..error }]), "")
}

fn node(at: At, given: &Bound<PyAny>, deep: usize) -> PyResult<Node> {
    Ok(Node {
        value: nested(at, given, deep)?,
        origin: at.origin.to_owned(),
    })
}

fn table(at: At, dict: &Bound<PyDict>, deep: usize) -> PyResult<Value> {
    let mut table = Table::new();
    for (key, given) in dict {
        if at.skips_none && given.is_none() {
            continue;
        }
        let key = key.str()?.to_string();
        let path: Vec<String> = at.path.iter().chain([&key]).cloned().collect();
        table.insert(key, node(At { path: &path, ..at }, &given, deep)?);
    }
    Ok(Value::Table(table))
}

fn as_dict<'py>(py: Python<'py>, scenario: &Scenario) -> PyResult<Bound<'py, PyDict>> {
    let (configuration, study) = (&scenario.configuration, &scenario.study);
    let robots = PyDict::new(py);
    for (kind, count) in &configuration.robots {
        robots.set_item(kind, count)?;
    }
    let published = scenario.published.as_ref();
    let published = published.map(|published| published_dict(py, published));
    let dict = PyDict::new(py);
    dict.set_item("engine", scenario.engine)?;
    dict.set_item("summary", &scenario.summary)?;
    dict.set_item("merit", merit_dict(py, &scenario.merit)?)?;
    dict.set_item("robots", robots)?;
    dict.set_item("time_limit_s", configuration.time_limit_s)?;
    dict.set_item("facts", configuration.facts.clone())?;
    dict.set_item("factors", factor_dicts(py, &study.factors)?)?;
    dict.set_item("design", study.design.to_string())?;
    dict.set_item("delta", study.delta)?;
    dict.set_item("confidence", study.confidence)?;
    dict.set_item("cost", &study.minimize)?;
    dict.set_item("where", study.filter.as_ref())?;
    let requirement = scenario.requirement.as_ref();
    let requirement = requirement.map(|requirement| requirement_dict(py, scenario, requirement));
    dict.set_item("requirement", requirement.transpose()?)?;
    dict.set_item("published", published.transpose()?)?;
    Ok(dict)
}

/// `conditions` are (text, column, operator, number).
fn requirement_dict<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    requirement: &Requirement,
) -> PyResult<Bound<'py, PyDict>> {
    let columns = scenario.configuration.runner.columns();
    let conditions = requirement.conditions.iter().map(|(text, condition)| {
        let column = columns
            .get(condition.place)
            .map(|column| column.name.to_string());
        let operator = condition.operator.to_string();
        (text.clone(), column, operator, condition.number)
    });
    let dict = PyDict::new(py);
    dict.set_item("conditions", conditions.collect::<Vec<_>>())?;
    dict.set_item("probability", requirement.probability)?;
    dict.set_item("tolerance", requirement.tolerance)?;
    Ok(dict)
}

/// `terms` are (name, column, weight, max or None).
fn merit_dict<'py>(py: Python<'py>, merit: &Merit) -> PyResult<Bound<'py, PyDict>> {
    let terms = merit.terms.iter();
    let terms: Vec<_> = terms
        .map(|term| (&*term.name, &*term.column, term.weight, term.max))
        .collect();
    let dict = PyDict::new(py);
    dict.set_item("name", merit.name)?;
    dict.set_item("terms", terms)?;
    Ok(dict)
}

/// Each with `path`, `values` (a list; empty for a range) and `range` ((low, high) or None).
fn factor_dicts<'py>(py: Python<'py>, factors: &[Factor]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let factor = |factor: &Factor| {
        let (listed, range) = match &factor.values {
            Values::Between(low, high) => (&[][..], Some((*low, *high))),
            Values::Listed(listed) => (&listed[..], None),
        };
        let values: PyResult<Vec<_>> = listed.iter().map(|value| plain(py, value)).collect();
        let dict = PyDict::new(py);
        dict.set_item("path", &factor.path)?;
        dict.set_item("values", values?)?;
        dict.set_item("range", range)?;
        Ok(dict)
    };
    factors.iter().map(factor).collect()
}

/// Converts a document value to Python; a date becomes a string.
pub(crate) fn plain<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Bool(value) => Ok(PyBool::new(py, *value).to_owned().into_any()),
        Value::Integer(number) => number.into_bound_py_any(py),
        Value::Float(number) => number.into_bound_py_any(py),
        Value::Text(text) | Value::Date(text) => text.into_bound_py_any(py),
        Value::List(items) => {
            let items = items.iter().map(|item| plain(py, &item.value));
            items.collect::<PyResult<Vec<_>>>()?.into_bound_py_any(py)
        }
        Value::Table(table) => {
            let dict = PyDict::new(py);
            for (key, node) in table {
                dict.set_item(key, plain(py, &node.value)?)?;
            }
            Ok(dict.into_any())
        }
    }
}

fn published_dict<'py>(py: Python<'py>, published: &Published) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("source", &published.source)?;
    dict.set_item("choice", published.choice)?;
    dict.set_item("time_limit_s", published.time_limit_s)?;
    dict.set_item("times_s", published.times_s.clone())?;
    Ok(dict)
}
