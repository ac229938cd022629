//! Documents in TOML, and in the plain YAML of maps, that are checked as a whole: all errors are
//! reported at once, each with its line.
//!
//! serde stops at the first error and does not keep lines. Here, the text becomes a tree of [`Node`]s
//! with their origins ([`parse`]), command-line options replace nodes ([`Document::set`]), and a
//! [`Section`] reads typed values and collects errors. [`schema`] checks a document against a JSON
//! Schema instead.
//!
//! ```
//! use base::document::{Document, Section, Value};
//! let mut document = Document::parse("job.toml", "time_limit_s = 120\n[robots]\ncount = 0")?;
//! document.set(&["time_limit_s"], Value::Float(-1.0), "--cap");
//! let errors = document
//!     .read(|root: &Section| {
//!         root.only(&["time_limit_s", "robots"]);
//!         let time_limit_s = root.number("time_limit_s", 0.0..=1e6);
//!         let count = root.section("robots").integer("count", 1..=100);
//!         Some((time_limit_s?, count?))
//!     })
//!     .unwrap_err();
//! assert_eq!(
//!     errors.to_string(),
//!     "--cap: time_limit_s = -1.0: must be a number from 0 to 1000000\n\
//!      job.toml:3: robots.count = 0: must be a whole number from 1 to 100"
//! );
//! # Ok::<(), base::error::InputErrors>(())
//! ```

mod parse;
mod place;
pub(crate) mod renamed;
pub mod schema;
mod section;
mod typed;
mod yaml;

pub use place::Place;
pub use section::Section;

use crate::error::{InputError, InputErrors};
use std::cell::RefCell;
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

/// The error of a `key` in the table at `path` that is none of the `known`: a renamed or an unknown one.
fn unknown_key<'k>(
    path: &str,
    key: &str,
    value: String,
    known: impl Iterator<Item = &'k str> + Clone,
) -> InputError {
    let at = path_of(path, key);
    match renamed::key(key, known.clone()) {
        Some(new) => InputError::renamed(at, None, path_of(path, new)),
        None => InputError::unknown_key(at, key, value, known),
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "beyond 2^53 it is rounded, as other TOML readers do"
)]
fn as_number(node: &Node) -> Option<f64> {
    match node.value {
        Value::Integer(value) => Some(value as f64),
        Value::Float(value) => Some(value),
        _ => None,
    }
}

/// A value that replaces one of the file, with its origin for errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    /// Keys from the root.
    pub path: Vec<String>,
    /// The new value.
    pub value: Value,
    /// Origin in errors, such as `--set clock.time_limit_s`.
    pub origin: String,
}

/// A document, and those of the files that it refers to that have been read.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    root: Node,
    files: Files,
    made: Vec<Made>,
}

/// A table that was created for a value in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// Path of the value.
    pub path: Vec<String>,
    /// Index in the path of the key of the table.
    pub place: usize,
}

/// Files by their names in the document: their bytes, or the reason why they cannot be read.
pub type Files = BTreeMap<String, Result<Vec<u8>, String>>;

impl Default for Document {
    /// An empty document.
    fn default() -> Self {
        Self::of(Node {
            value: Value::Table(Table::new()),
            origin: String::new(),
        })
    }
}

impl Document {
    /// Reads TOML `text`; `file` is its name in errors.
    ///
    /// # Errors
    /// All syntax errors.
    pub fn parse(file: &str, text: &str) -> Result<Self, InputErrors> {
        parse::parse(file, text).map(Self::of)
    }

    /// Reads plain YAML `text`: mappings, lists and plain values, a few levels deep. `file` is its name
    /// in errors.
    ///
    /// Aliases and tags are not supported, so that a short text cannot become a large document.
    ///
    /// # Errors
    /// Everything that is not plain YAML.
    pub fn parse_yaml(file: &str, text: &str) -> Result<Self, InputErrors> {
        yaml::parse(file, text).map(Self::of)
    }

    fn of(root: Node) -> Self {
        Self {
            root,
            files: Files::new(),
            made: Vec::new(),
        }
    }

    /// The document with files that it refers to.
    #[must_use]
    pub fn with_files(mut self, files: Files) -> Self {
        self.files = files;
        self
    }

    /// The bytes of a file that it refers to.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn open(&self, name: &str) -> Result<Vec<u8>, String> {
        let not_there = || Err("it has not been read".to_owned());
        self.files.get(name).cloned().unwrap_or_else(not_there)
    }

    /// Whether a file that it refers to has been read, successfully or not.
    #[must_use]
    pub fn has_file(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// Sets the value at `path`; `origin` is its origin in errors.
    ///
    /// Missing tables on the path are created; other values on the path are replaced by tables.
    pub fn set(&mut self, path: &[&str], value: Value, origin: &str) {
        self.made.extend(self.missing(path));
        let mut node = &mut self.root;
        for key in path {
            if !matches!(node.value, Value::Table(_)) {
                node.value = Value::Table(Table::new());
            }
            let Value::Table(table) = &mut node.value else {
                return;
            };
            node = table.entry((*key).to_owned()).or_insert_with(|| Node {
                value: Value::Table(Table::new()),
                origin: origin.to_owned(),
            });
        }
        *node = Node {
            value,
            origin: origin.to_owned(),
        };
    }

    /// The outermost table that is missing on a path.
    fn missing(&self, path: &[&str]) -> Option<Made> {
        let is_missing = |place: &usize| self.get(&path[..=*place]).is_none();
        Some(Made {
            place: (0..path.len().saturating_sub(1)).find(is_missing)?,
            path: path.iter().map(|key| (*key).to_owned()).collect(),
        })
    }

    /// The tables that were created for values in them.
    #[must_use]
    pub fn made(&self) -> &[Made] {
        &self.made
    }

    /// Fills missing keys of the table at `path` from `defaults`.
    ///
    /// Tables are merged key by key, except for tables of a different `kind`. Existing values stay.
    /// Without a table at `path`, nothing happens.
    pub fn fill(&mut self, path: &[&str], defaults: &Self) {
        let node = path
            .iter()
            .try_fold(&mut self.root, |node, key| match &mut node.value {
                Value::Table(table) => table.get_mut(*key),
                _ => None,
            });
        if let Some(node) = node {
            fill(node, &defaults.root);
        }
    }

    /// Applies `overrides` in their order.
    #[must_use]
    pub fn with(mut self, overrides: &[Override]) -> Self {
        for each in overrides {
            let path: Vec<&str> = each.path.iter().map(String::as_str).collect();
            self.set(&path, each.value.clone(), &each.origin);
        }
        self
    }

    /// The node at `path`.
    #[must_use]
    pub fn get(&self, path: &[&str]) -> Option<&Node> {
        path.iter()
            .try_fold(&self.root, |node, key| match &node.value {
                Value::Table(table) => table.get(*key),
                _ => None,
            })
    }

    /// The result of `reader`, if the sections report no errors.
    ///
    /// `reader` should check everything before it returns, so that all errors are reported at once.
    ///
    /// # Errors
    /// All errors that the sections report.
    pub fn read<T>(&self, reader: impl FnOnce(&Section) -> Option<T>) -> Result<T, InputErrors> {
        let (value, errors) = self.read_all(reader);
        InputErrors::or(errors, value)
    }

    /// The result of `reader`, and all errors that the sections report.
    pub fn read_all<T>(
        &self,
        reader: impl FnOnce(&Section) -> Option<T>,
    ) -> (Option<T>, Vec<InputError>) {
        let errors = RefCell::new(Vec::<InputError>::new());
        let value = reader(&Section::root(&self.root, &errors));
        (value, errors.into_inner())
    }
}

fn fill(node: &mut Node, defaults: &Node) {
    let (Value::Table(table), Value::Table(defaults)) = (&mut node.value, &defaults.value) else {
        return;
    };
    let kind_of = |table: &Table| table.get("kind").map(|node| node.value.clone());
    if kind_of(table).is_some_and(|kind| kind_of(defaults).is_some_and(|other| kind != other)) {
        return;
    }
    for (key, value) in defaults {
        match table.get_mut(key) {
            Some(node) => fill(node, value),
            None => {
                table.insert(key.clone(), value.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests;
