//! What serde refuses of percepts and commands, in a person's words: those of its schema.

use base::document::schema::Schema;
use base::document::{Document, Node, Value, path_of};
use base::error::InputError;
use schemars::JsonSchema;
use serde_json::Value as Json;
use serde_path_to_error::{Path, Segment};

/// What in `json` serde has refused at `path` when it read a `T`.
pub(crate) fn error<T: JsonSchema>(json: &Json, path: &Path) -> InputError {
    let at = path.iter().fold(String::new(), |at, each| match each {
        Segment::Seq { index } => format!("{at}[{index}]"),
        Segment::Map { key } | Segment::Enum { variant: key } => path_of(&at, key),
        Segment::Unknown => at,
    });
    let mut document = Document::default();
    document.set(&[], value(json), "");
    let errors = Schema::of::<T>().errors(&document).into_iter();
    // PythonBrain the schema refuses what a percept may say: None for what is not there.
    let mut here =
        errors.filter(|error| error.path.starts_with(&at) || at.starts_with(&error.path));
    let error = here.next();
    // Whatever serde refuses, the schema does; should they disagree, the place is told.
    let error = error.unwrap_or_else(|| InputError::new(at, None, "another value".to_owned()));
    InputError {
        origin: None,
        allowed: as_in_python(&error.allowed),
        ..error
    }
}

/// What is allowed, where tables are dicts, and texts have their quotes.
pub(crate) fn as_in_python(allowed: &str) -> String {
    let words = [
        ("a table", "a dict"),
        ("tables", "dicts"),
        (" in quotes", ""),
        ("true or false", "True or False"),
    ];
    words
        .iter()
        .fold(allowed.to_owned(), |allowed, (word, python)| {
            allowed.replace(word, python)
        })
}

/// As documents have it, which have no None: it is nothing that a schema allows.
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
