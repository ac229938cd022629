//! The values of a document, with their origins.

use std::collections::BTreeMap;
use std::fmt;

/// A table, sorted by key.
pub type Table = BTreeMap<String, Node>;

/// A value and its origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// `FILE:LINE`, or the option that set it.
    pub origin: String,
}

/// A value in a document. TOML has dates; no scenario allows them.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// Any other number, infinities and NaN among them.
    Float(f64),
    /// A string.
    Text(String),
    /// A date or time, as written.
    Date(String),
    /// An array.
    List(Vec<Node>),
    /// A table.
    Table(Table),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => write!(f, "{value}"),
            Self::Integer(value) => write!(f, "{value}"),
            Self::Float(value) => write!(f, "{value:?}"),
            Self::Text(value) => write!(f, "{value:?}"),
            Self::Date(value) => write!(f, "{value}"),
            Self::List(items) => {
                let items: Vec<String> = items.iter().map(|item| item.value.to_string()).collect();
                write!(f, "[{}]", items.join(", "))
            }
            Self::Table(_) => f.write_str("{...}"),
        }
    }
}

/// A bound of a range in its shortest form: `120` instead of `120.0`, `1e308` instead of 300 digits.
pub(crate) fn written(value: f64) -> String {
    let shortest = format!("{value:?}");
    shortest.strip_suffix(".0").unwrap_or(&shortest).to_owned()
}

/// The path of `key` in the table at `path`, which is empty for the root.
#[must_use]
pub fn path_of(path: &str, key: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let key = if !key.is_empty() && key.chars().all(bare) {
        key.to_owned()
    } else {
        format!("{key:?}")
    };
    if path.is_empty() {
        key
    } else {
        format!("{path}.{key}")
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "beyond 2^53 it is rounded, as other TOML readers do"
)]
pub(super) fn as_number(node: &Node) -> Option<f64> {
    match node.value {
        Value::Integer(value) => Some(value as f64),
        Value::Float(value) => Some(value),
        _ => None,
    }
}
