//! Converts serde errors of percepts and commands to errors in the terms of their schema.

use base::document::schema::Schema;
use base::document::{Document, Node, Value, path_of};
use base::error::InputError;
use schemars::JsonSchema;
use serde_json::Value as Json;
use serde_path_to_error::{Path, Segment};

/// The error at `path`, where serde failed to read a `T` from `json`.
pub(crate) fn error<T: JsonSchema>(json: &Json, path: &Path) -> InputError {
    let at = path.iter().fold(String::new(), |at, each| match each {
        Segment::Seq { index } => format!("{at}[{index}]"),
        Segment::Map { key } | Segment::Enum { variant: key } => path_of(&at, key),
        Segment::Unknown => at,
    });
    let mut document = Document::default();
    document.set(&[], value(json), "");
    let errors = Schema::of::<T>().errors(&document).into_iter();
    // Elsewhere, the schema rejects values that a percept allows: None for missing ones.
    let mut here =
        errors.filter(|error| error.path.starts_with(&at) || at.starts_with(&error.path));
    let error = here.next();
    // The schema rejects whatever serde does; if they disagree, at least the path is reported.
    let error = error.unwrap_or_else(|| InputError::new(at, None, "another value".to_owned()));
    InputError {
        origin: None,
        allowed: as_in_python(&error.allowed),
        ..error
    }
}

/// Replaces TOML terms by Python terms.
pub(crate) fn as_in_python(allowed: &str) -> String {
    let words = [
        ("a table", "a dict"),
        ("tables", "dicts"),
        ("true or false", "True or False"),
    ];
    words
        .iter()
        .fold(allowed.to_owned(), |allowed, (word, python)| {
            allowed.replace(word, python)
        })
}

/// The value as documents have it. They have no None; its substitute is a value that no schema allows.
fn value(json: &Json) -> Value {
    let node = |json| Node {
        value: value(json),
        origin: String::new(),
    };
    match json {
        Json::Null => Value::Date("None".to_owned()),
        Json::Bool(truth) => Value::Bool(*truth),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => Value::Integer(whole),
            None => Value::Float(number.as_f64().unwrap_or(f64::NAN)),
        },
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(items) => Value::List(items.iter().map(node).collect()),
        Json::Object(entries) => {
            let entries = entries.iter().map(|(key, json)| (key.clone(), node(json)));
            Value::Table(entries.collect())
        }
    }
}
