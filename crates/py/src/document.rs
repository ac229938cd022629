//! TOML documents that Python checks: against a JSON Schema, and by rules of its own, each error with
//! the line of its value.

use crate::configuration::warning_dict;
use crate::error::{error_dict, input_error};
use crate::scenario::plain;
use base::document::schema::Schema;
use base::document::{self, Place};
use base::error::{InputError, Problem, nearest};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A document in TOML.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct Document {
    file: String,
    document: document::Document,
}

/// A part of a path: a key of a table, or an index of a list.
#[derive(FromPyObject)]
enum Part {
    Index(usize),
    Key(String),
}

#[pymethods]
impl Document {
    /// Reads `text`; `file` is its name in errors. Raises all syntax errors.
    #[new]
    fn new(file: String, text: &str) -> PyResult<Self> {
        let parsed = document::Document::parse(&file, text);
        let document = parsed.map_err(|errors| input_error(&errors, &file))?;
        Ok(Self { file, document })
    }

    /// The whole document, unchecked, as dicts, lists and values.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let root = self.document.get(&[]);
        root.map_or_else(
            || Ok(PyDict::new(py).into_any()),
            |root| plain(py, &root.value),
        )
    }

    /// All errors of the document against a JSON Schema, as dicts.
    fn errors<'py>(&self, py: Python<'py>, schema: &str) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let schema: schemars::Schema = serde_json::from_str(schema)
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        let errors = Schema::closed(schema).errors(&self.document);
        let dicts = errors.iter().map(|error| error_dict(py, error, &self.file));
        dicts.collect()
    }

    /// The error that the value at `path` is not what is `allowed`, or missing, as a dict. If it is a
    /// string, the nearest of the `names` is suggested.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 passes an owned list")]
    fn error<'py>(
        &self,
        py: Python<'py>,
        path: Vec<Part>,
        allowed: String,
        names: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let error = self.place(&path).error(allowed);
        let word = error.value().map(|value| value.trim_matches('"'));
        let near = word.and_then(|word| nearest(word, names.iter().map(String::as_str)));
        let suggestion = near.map(|name| format!("{name:?}"));
        error_dict(
            py,
            &InputError {
                suggestion,
                ..error
            },
            &self.file,
        )
    }

    /// The error that the last key of `path` is not what is `allowed`, as a dict. The nearest of the
    /// `names` is suggested.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 passes an owned list")]
    fn unknown_key<'py>(
        &self,
        py: Python<'py>,
        path: Vec<Part>,
        allowed: String,
        names: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let place = self.place(&path);
        let key = match path.last() {
            Some(Part::Key(key)) => key,
            _ => "",
        };
        let near = nearest(key, names.iter().map(String::as_str));
        let error = InputError {
            problem: Problem::UnknownKey(place.value().unwrap_or_default()),
            suggestion: near.map(str::to_owned),
            ..place.error(allowed)
        };
        error_dict(py, &error, &self.file)
    }

    /// A warning about the value at `path`, as a dict.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 passes an owned list")]
    fn warning<'py>(
        &self,
        py: Python<'py>,
        path: Vec<Part>,
        effect: String,
    ) -> PyResult<Bound<'py, PyDict>> {
        warning_dict(py, &self.place(&path).warning(effect), &self.file)
    }
}

impl Document {
    fn place(&self, path: &[Part]) -> Place<'_> {
        let root = self.document.place();
        path.iter().fold(root, |place, part| match part {
            Part::Index(index) => place.item(*index),
            Part::Key(key) => place.key(key),
        })
    }
}
