//! A document: its root, overrides of values, and the files that it refers to.

use super::node::{Node, Table, Value};
use super::section::Section;
use super::{parse, yaml};
use crate::error::{InputError, InputErrors};
use std::cell::RefCell;
use std::collections::BTreeMap;

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
    pub(super) root: Node,
    files: Files,
    created_tables: Vec<CreatedTable>,
    /// What [`Document::vary`] replaced first, by path.
    varied: BTreeMap<Vec<String>, Option<Value>>,
}

/// A table that was created for a value in it.
#[derive(Debug, Clone, PartialEq)]
pub struct CreatedTable {
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

    /// A document of this table.
    #[must_use]
    pub fn of_table(table: Table, origin: &str) -> Self {
        Self::of(Node {
            value: Value::Table(table),
            origin: origin.to_owned(),
        })
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
            created_tables: Vec::new(),
            varied: BTreeMap::new(),
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
        self.created_tables.extend(self.missing(path));
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

    /// As [`Document::set`], for a value of a configuration: the document keeps its [own](Document::own).
    pub fn vary(&mut self, path: &[&str], value: Value, origin: &str) {
        let keys = path.iter().map(|key| (*key).to_owned()).collect();
        let current = self.get(path).map(|node| node.value.clone());
        self.varied.entry(keys).or_insert(current);
        self.set(path, value, origin);
    }

    /// The value at `path`, or the one there before [`Document::vary`] replaced it.
    #[must_use]
    pub fn own(&self, path: &[&str]) -> Option<&Value> {
        let keys: Vec<String> = path.iter().map(|key| (*key).to_owned()).collect();
        match self.varied.get(&keys) {
            Some(own) => own.as_ref(),
            None => self.get(path).map(|node| &node.value),
        }
    }

    /// The outermost table that is missing on a path.
    fn missing(&self, path: &[&str]) -> Option<CreatedTable> {
        let is_missing = |place: &usize| self.get(&path[..=*place]).is_none();
        Some(CreatedTable {
            place: (0..path.len().saturating_sub(1)).find(is_missing)?,
            path: path.iter().map(|key| (*key).to_owned()).collect(),
        })
    }

    /// The tables that were created for values in them.
    #[must_use]
    pub fn created_tables(&self) -> &[CreatedTable] {
        &self.created_tables
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
