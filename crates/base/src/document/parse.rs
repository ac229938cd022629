//! Parses TOML into nodes with their lines.

use super::node::{Node, Table, Value};
use crate::error::{InputError, InputErrors};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Reads `text`, or reports all syntax errors.
pub(super) fn parse(file: &str, text: &str) -> Result<Node, InputErrors> {
    let lines = Lines::new(file, text);
    let (table, errors) = DeTable::parse_recoverable(text);
    let errors: Vec<InputError> = errors.iter().map(|error| lines.error(error)).collect();
    let root = Node {
        value: lines.table(table.get_ref()),
        origin: file.to_owned(),
    };
    InputErrors::or(errors, Some(root))
}

/// The offsets at which the lines of a string begin.
struct Lines<'t> {
    file: &'t str,
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn new(file: &'t str, text: &str) -> Self {
        let after_breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        Self {
            file,
            starts: std::iter::once(0).chain(after_breaks).collect(),
        }
    }

    fn origin(&self, span: &Range<usize>) -> String {
        let line = self.starts.partition_point(|start| *start <= span.start);
        format!("{}:{line}", self.file)
    }

    fn error(&self, error: &toml::de::Error) -> InputError {
        let allowed = format!("not valid TOML: {}", error.message());
        InputError {
            origin: Some(self.origin(&error.span().unwrap_or(0..0))),
            ..InputError::new(String::new(), None, allowed)
        }
    }

    fn node(&self, spanned: &Spanned<DeValue>, origin: String) -> Node {
        Node {
            value: self.value(spanned.get_ref()),
            origin,
        }
    }

    /// The line of a value is that of its key: the span of a table may begin anywhere.
    fn table(&self, table: &DeTable) -> Value {
        let entry = |(key, value): (&Spanned<_>, &Spanned<_>)| {
            let key_text: &std::borrow::Cow<str> = key.get_ref();
            let node = self.node(value, self.origin(&key.span()));
            (key_text.to_string(), node)
        };
        Value::Table(table.iter().map(entry).collect::<Table>())
    }

    fn value(&self, value: &DeValue) -> Value {
        match value {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(integer) => integer_value(integer),
            DeValue::Float(float) => Value::Float(float.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(value) => Value::Bool(*value),
            DeValue::Datetime(date) => Value::Date(date.to_string()),
            DeValue::Array(items) => Value::List(
                items
                    .iter()
                    .map(|item| self.node(item, self.origin(&item.span())))
                    .collect(),
            ),
            DeValue::Table(table) => self.table(table),
        }
    }
}

/// Integers beyond 64 bits become floats, which are out of any range here.
fn integer_value(integer: &toml::de::DeInteger) -> Value {
    let (text, radix) = (integer.as_str(), integer.radix());
    i64::from_str_radix(text, radix).map_or_else(
        |_| Value::Float(text.parse().unwrap_or(f64::INFINITY)),
        Value::Integer,
    )
}
