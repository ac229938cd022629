//! Checks each value of each factor: puts it into the scenario and reads that.

use super::factors::{in_order_of, put};
use super::unknown_names::{Unknown, read};
use super::values::{Values, values};
use crate::document::{Document, Node, Value};
use crate::engine::{Configuration, Engine};
use crate::error::{InputError, InputErrors, Problem, shortened};

/// Maximum number of values of one factor that are reported one by one.
const MAX_REPORTED: usize = 3;

/// The errors of single values. `base` is the configuration without any of them, and `known` are its
/// errors.
pub(super) fn errors_of_values(
    engine: &dyn Engine,
    document: &Document,
    base: Option<&Configuration>,
    known: &[InputError],
) -> Vec<InputError> {
    let Some(Value::Table(vary)) = document.get(&["study", "vary"]).map(|node| &node.value) else {
        return Vec::new();
    };
    // In place of a value that is not a table, a factor's value would create a table that lacks its
    // other keys.
    let is_readable = |path: &&str| {
        let below = |error: &InputError| path.strip_prefix(error.path.as_str());
        let mut below = known.iter().filter_map(below);
        !below.any(|rest| rest.starts_with('.'))
    };
    let paths = in_order_of(engine, vary.keys().map(String::as_str)).filter(is_readable);
    let check = ValueCheck {
        engine,
        document,
        base,
        known,
    };
    paths
        .filter_map(|path| Some(check.errors(path, vary.get(path)?)))
        .flatten()
        .collect()
}

/// A scenario into which values are put.
struct ValueCheck<'t> {
    engine: &'t dyn Engine,
    document: &'t Document,
    base: Option<&'t Configuration>,
    known: &'t [InputError],
}

impl ValueCheck<'_> {
    /// The errors of the values of one factor.
    fn errors(&self, path: &str, node: &Node) -> Vec<InputError> {
        let (listed, origin) = (&node.value, &node.origin);
        let values = match listed {
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
            return vec![unknown.error(listed, origin, &[])];
        }
        self.shortened(errors, path, origin)
    }

    /// The error of a value that has been put into a document.
    fn error(
        &self,
        path: &str,
        value: &Value,
        origin: &str,
        varied: &Document,
    ) -> Option<InputError> {
        match read(self.engine, varied) {
            Err(InputErrors(errors)) => {
                let new = errors.into_iter().find(|error| !self.known.contains(error));
                new.map(|error| about(path, value, origin, error))
            }
            Ok(read) => self.base.filter(|base| !is_alike(base, &read)).map(|_| {
                let allowed = "a value of an existing robot, item or other entry of the scenario";
                InputError {
                    origin: Some(origin.to_owned()),
                    ..InputError::new(path.to_owned(), Some(value.to_string()), allowed.to_owned())
                }
            }),
        }
    }

    /// The first errors, and the number of others. Only the first if the scenario lacks the path: the
    /// path itself may be wrong.
    fn shortened(&self, mut errors: Vec<InputError>, path: &str, origin: &str) -> Vec<InputError> {
        let keys: Vec<&str> = path.split('.').collect();
        if let Some(renamed) = errors
            .iter()
            .find(|error| matches!(error.problem, Problem::Renamed(_)))
        {
            return vec![renamed.clone()];
        }
        let is_there = self.document.get(&keys).is_some();
        let max_reported = if is_there { MAX_REPORTED } else { 1 };
        let more = errors.len().saturating_sub(max_reported);
        if more > 0 {
            errors.truncate(max_reported);
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

/// Whether two configurations have the same kinds of robots and the same columns: with a misspelt
/// name, a value would create a new kind.
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

/// The error of a value, at the path of its factor. An error elsewhere (for example, a time limit that
/// is too long at a varied rate) would not name what to change.
fn about(path: &str, value: &Value, origin: &str, error: InputError) -> InputError {
    if error.path == path {
        return error;
    }
    let other = shortened(&error.path);
    let allowed = format!("a value with which {other} is {}", error.allowed);
    InputError {
        origin: Some(origin.to_owned()),
        ..InputError::new(path.to_owned(), Some(value.to_string()), allowed)
    }
}
