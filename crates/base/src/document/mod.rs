//! A document read against what is allowed, every error at once, each with its line: TOML, and the
//! plain YAML of maps.
//!
//! serde stops at the first error and forgets the line. Here the text becomes a tree of [`Node`]s
//! that know where they came from ([`parse`]), options of the command line replace nodes
//! ([`Document::set`]), and a [`Section`] reads typed values and collects what is wrong.
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

/// Keys and values of a table, in the order of the keys.
pub type Table = BTreeMap<String, Node>;

/// A value and where it was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// `FILE:LINE`, or the option that set it.
    pub origin: String,
}

/// What a document can hold. Dates are in TOML, and are allowed nowhere here.
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

/// An end of a range as a person writes it: `120` and not `120.0`, `1e308` and not 300 digits.
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
    reason = "a number that a person wrote; beyond 2^53 it is rounded, as TOML readers do"
)]
fn as_number(node: &Node) -> Option<f64> {
    match node.value {
        Value::Integer(value) => Some(value as f64),
        Value::Float(value) => Some(value),
        _ => None,
    }
}

/// A value put over what a file says, and how errors should name where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    /// Keys from the root.
    pub path: Vec<String>,
    /// The new value.
    pub value: Value,
    /// For example `--set clock.time_limit_s`.
    pub origin: String,
}

/// A whole document, and the files that it names, as far as they have been read.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    root: Node,
    files: Files,
    made: Vec<Made>,
}

/// A table that was not there and was made for a value in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// Of the value.
    pub path: Vec<String>,
    /// Which key of the path leads to the table, from 0.
    pub place: usize,
}

/// Files by the names by which a document calls them: their bytes, or why they cannot be read.
pub type Files = BTreeMap<String, Result<Vec<u8>, String>>;

impl Default for Document {
    /// An empty one.
    fn default() -> Self {
        Self::of(Node {
            value: Value::Table(Table::new()),
            origin: String::new(),
        })
    }
}

impl Document {
    /// Reads TOML `text`; `file` is how errors name it.
    ///
    /// # Errors
    /// Every place at which the text is not TOML.
    pub fn parse(file: &str, text: &str) -> Result<Self, InputErrors> {
        parse::parse(file, text).map(Self::of)
    }

    /// Reads the YAML `text` of one flat file: mappings, lists and plain values, a few levels deep.
    /// `file` is how errors name it.
    ///
    /// Aliases and tags are refused, so that a short text cannot become a large document.
    ///
    /// # Errors
    /// What in the text is not such YAML.
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

    /// The document with files that it names.
    #[must_use]
    pub fn with_files(mut self, files: Files) -> Self {
        self.files = files;
        self
    }

    /// The bytes of a file that it names.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn open(&self, name: &str) -> Result<Vec<u8>, String> {
        let not_there = || Err("it has not been read".to_owned());
        self.files.get(name).cloned().unwrap_or_else(not_there)
    }

    /// Whether it is known what is in a file that it names, or why it cannot be read.
    #[must_use]
    pub fn has_file(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// Puts `value` at `path`, over what the file says; `origin` is how errors name it.
    ///
    /// Tables on the way are made; something on the way that is no table is replaced by one.
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

    /// The tables that were made for what was put into them.
    #[must_use]
    pub fn made(&self) -> &[Made] {
        &self.made
    }

    /// Puts under the table at `path` all that `defaults` says and it does not.
    ///
    /// Tables are merged key by key, but for one whose `kind` is another: it is of another form.
    /// Anything else that is there stays. Nothing happens where no table stands.
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

    /// Puts each of `overrides` in its place, one after the other.
    #[must_use]
    pub fn with(mut self, overrides: &[Override]) -> Self {
        for each in overrides {
            let path: Vec<&str> = each.path.iter().map(String::as_str).collect();
            self.set(&path, each.value.clone(), &each.origin);
        }
        self
    }

    /// What stands at `path`.
    #[must_use]
    pub fn get(&self, path: &[&str]) -> Option<&Node> {
        path.iter()
            .try_fold(&self.root, |node, key| match &node.value {
                Value::Table(table) => table.get(*key),
                _ => None,
            })
    }

    /// What `reader` makes of the document, if it finds nothing wrong.
    ///
    /// `reader` should look at everything before it gives up, so that all errors are told at once.
    ///
    /// # Errors
    /// Everything that the sections found wrong.
    pub fn read<T>(&self, reader: impl FnOnce(&Section) -> Option<T>) -> Result<T, InputErrors> {
        let (value, errors) = self.read_all(reader);
        InputErrors::or(errors, value)
    }

    /// What `reader` makes of the document, and everything that the sections found wrong.
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
