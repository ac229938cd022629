//! Whether each value of each factor is allowed: it is put into the scenario, which is read.

use super::factors::{in_order_of, put};
use super::unknown_names::{Unknown, read};
use super::values::{Values, values};
use crate::document::{Document, Node, Value};
use crate::engine::{Configuration, Engine};
use crate::error::{InputError, InputErrors, shortened};

/// Bad values of one factor that are told one by one.
const TOLD: usize = 3;

/// What is wrong with single values: each is put into the document, which is read. `given` is what
/// the engine reads without it, and `known` what is wrong without it.
pub(super) fn errors_of_values(
    engine: &dyn Engine,
    document: &Document,
    given: Option<&Configuration>,
    known: &[InputError],
) -> Vec<InputError> {
    let Some(Value::Table(vary)) = document.get(&["study", "vary"]).map(|node| &node.value) else {
        return Vec::new();
    };
    // Where a section is no table, a value in it would make it one, and its other keys be missing.
    let is_readable = |path: &&str| {
        let below = |error: &InputError| path.strip_prefix(error.path.as_str());
        let mut below = known.iter().filter_map(below);
        !below.any(|rest| rest.starts_with('.'))
    };
    let paths = in_order_of(engine, vary.keys().map(String::as_str)).filter(is_readable);
    let trial = Trial {
        engine,
        document,
        given,
        known,
    };
    paths
        .filter_map(|path| Some(trial.errors(path, vary.get(path)?)))
        .flatten()
        .collect()
}

/// A scenario in which values are tried.
struct Trial<'t> {
    engine: &'t dyn Engine,
    document: &'t Document,
    given: Option<&'t Configuration>,
    known: &'t [InputError],
}

impl Trial<'_> {
    /// What is wrong with the values of one factor.
    fn errors(&self, path: &str, node: &Node) -> Vec<InputError> {
        let (given, origin) = (&node.value, &node.origin);
        let values = match given {
            Value::Text(text) => values(text).ok(),
            _ => None,
        };
        let values = match values {
            Some(Values::Listed(values)) => values,
            Some(Values::Between(low, high)) => vec![Value::Float(low), Value::Float(high)],
            None => return Vec::new(),
        };
        let mut varied = self.document.clone();
        let mut errors = Vec::new();
        for value in values {
            put(&mut varied, path, &value, origin);
            errors.extend(self.error(path, &value, origin, &varied));
        }
        let keys: Vec<&str> = path.split('.').collect();
        let unknown = Unknown::on(&keys, self.engine, self.document);
        if let Some(unknown) = unknown.filter(|_| !errors.is_empty()) {
            return vec![unknown.error(given, origin, &[])];
        }
        self.shortened(errors, path, origin)
    }

    /// What is wrong with a value that has been put into a document.
    fn error(
        &self,
        path: &str,
        value: &Value,
        origin: &str,
        varied: &Document,
    ) -> Option<InputError> {
        match read(self.engine, varied) {
            Err(InputErrors(told)) => {
                let new = told.into_iter().find(|error| !self.known.contains(error));
                new.map(|error| about(path, value, origin, error))
            }
            Ok(read) => self.given.filter(|given| !is_alike(given, &read)).map(|_| {
                let allowed = "of a robot, an item or another thing that the scenario has";
                InputError {
                    origin: Some(origin.to_owned()),
                    ..InputError::new(path.to_owned(), Some(value.to_string()), allowed.to_owned())
                }
            }),
        }
    }

    /// The first errors, and how many more there are. Of a path that the scenario does not have one
    /// will do: the path itself may be wrong.
    fn shortened(&self, mut errors: Vec<InputError>, path: &str, origin: &str) -> Vec<InputError> {
        let keys: Vec<&str> = path.split('.').collect();
        let is_there = self.document.get(&keys).is_some();
        let told = if is_there { TOLD } else { 1 };
        let more = errors.len().saturating_sub(told);
        if more > 0 {
            errors.truncate(told);
            let path = shortened(path);
            let sentence = format!("{more} more values of {path} are not allowed either");
            errors.push(InputError {
                origin: Some(origin.to_owned()),
                ..InputError::new(String::new(), None, sentence)
            });
        }
        errors
    }
}

/// Whether two configurations have the same kinds of robots, and tell the same columns: with a
/// misspelt name a value would make a kind of its own.
fn is_alike(one: &Configuration, other: &Configuration) -> bool {
    let kinds = |of: &Configuration| -> Vec<String> {
        of.robots.iter().map(|(kind, _)| kind.clone()).collect()
    };
    let names = |of: &Configuration| -> Vec<_> {
        let columns = of.runner.columns().into_iter();
        columns.map(|column| column.name).collect()
    };
    kinds(one) == kinds(other) && names(one) == names(other)
}

/// A value's error as the factor's: one that is told elsewhere, as of a cap that is too many paints
/// at a varied rate, would not name what to change.
fn about(path: &str, value: &Value, origin: &str, error: InputError) -> InputError {
    if error.path == path {
        return error;
    }
    let other = shortened(&error.path);
    let allowed = format!("one with which {other} is {}", error.allowed);
    InputError {
        origin: Some(origin.to_owned()),
        ..InputError::new(path.to_owned(), Some(value.to_string()), allowed)
    }
}
