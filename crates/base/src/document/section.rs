//! Typed reading of a table that collects all errors.

use super::node::{Node, Table, Value, as_number, path_of, written};
use super::renamed::{self, unknown_key};
use crate::error::InputError;
use std::cell::RefCell;
use std::ops::RangeInclusive;

/// One table of a document. A missing table reads as an empty one, so that each required value in it
/// is reported as missing.
#[derive(Debug)]
pub struct Section<'d> {
    table: Option<&'d Table>,
    origin: &'d str,
    path: String,
    /// Whether a value that is not a table stands here. That is one error; its contents are not
    /// reported as missing.
    is_invalid: bool,
    errors: &'d RefCell<Vec<InputError>>,
}

impl<'d> Section<'d> {
    pub(super) fn root(node: &'d Node, errors: &'d RefCell<Vec<InputError>>) -> Self {
        Self {
            table: as_table(node),
            origin: &node.origin,
            path: String::new(),
            is_invalid: false,
            errors,
        }
    }

    /// Reports every key that is not among `keys`.
    pub fn only(&self, keys: &[&str]) {
        for key in self.keys().filter(|key| !keys.contains(key)) {
            self.report_unknown(key, keys);
        }
    }

    /// Reports that `key` is none of the known `keys`.
    pub fn report_unknown(&self, key: &str, keys: &[&str]) {
        let value = self.value(key).map(ToString::to_string).unwrap_or_default();
        let error = unknown_key(&self.path, key, value, keys.iter().copied());
        self.report(key, error);
    }

    /// Whether the table has `key`.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.node(key).is_some()
    }

    /// The value at `key`, unchecked.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<&'d Value> {
        self.node(key).map(|node| &node.value)
    }

    /// Origin of the value at `key`; without one, that of the table.
    #[must_use]
    pub fn origin(&self, key: &str) -> &'d str {
        self.node(key).map_or(self.origin, |node| &node.origin)
    }

    /// The keys of the table, in their order.
    pub fn keys(&self) -> impl Iterator<Item = &'d str> + use<'d> {
        self.table
            .into_iter()
            .flatten()
            .map(|(key, _)| key.as_str())
    }

    /// The table at `key`.
    #[must_use]
    pub fn section(&self, key: &str) -> Section<'d> {
        let node = self.node(key);
        let table = node.and_then(as_table);
        let is_no_table = node.is_some() && table.is_none();
        if is_no_table {
            self.error(key, "a table");
        }
        Section {
            table,
            origin: node.map_or(self.origin, |node| &node.origin),
            path: self.path_of(key),
            is_invalid: self.is_invalid || is_no_table,
            errors: self.errors,
        }
    }

    /// The whole number at `key`, if it is one in `range`.
    #[must_use]
    pub fn integer(&self, key: &str, range: RangeInclusive<i64>) -> Option<i64> {
        let value = match self.node(key).map(|node| &node.value) {
            Some(Value::Integer(value)) if range.contains(value) => Some(*value),
            _ => None,
        };
        let (low, high) = range.into_inner();
        self.checked(value, key, || {
            format!("a whole number from {low} to {high}")
        })
    }

    /// The number at `key`, if it is one in `range`.
    #[must_use]
    pub fn number(&self, key: &str, range: RangeInclusive<f64>) -> Option<f64> {
        let value = self.node(key).and_then(as_number);
        let value = value.filter(|value| range.contains(value));
        self.checked(value, key, || {
            let (low, high) = (written(*range.start()), written(*range.end()));
            format!("a number from {low} to {high}")
        })
    }

    /// The number at `key`, if it is one that `holds`; else it must be `allowed`.
    #[must_use]
    pub fn number_if(&self, key: &str, allowed: &str, holds: impl Fn(f64) -> bool) -> Option<f64> {
        let value = self.node(key).and_then(as_number);
        let value = value.filter(|value| value.is_finite() && holds(*value));
        self.checked(value, key, || allowed.to_owned())
    }

    /// The list of numbers at `key`, if it holds at least one and all are in `range`.
    #[must_use]
    pub fn numbers(&self, key: &str, range: RangeInclusive<f64>) -> Option<Vec<f64>> {
        let (low, high) = (written(*range.start()), written(*range.end()));
        let Some(Value::List(items)) = self.node(key).map(|node| &node.value) else {
            self.error(key, &format!("a list of numbers from {low} to {high}"));
            return None;
        };
        if items.is_empty() {
            self.error(key, "a list of at least one number");
        }
        let number = |(index, item): (usize, &Node)| {
            let number = as_number(item).filter(|number| range.contains(number));
            if number.is_none() {
                let path = format!("{}[{index}]", self.path_of(key));
                let allowed = format!("a number from {low} to {high}");
                self.report(
                    key,
                    InputError::new(path, Some(item.value.to_string()), allowed),
                );
            }
            number
        };
        // Check all items before giving up, to report all errors.
        let numbers: Vec<Option<f64>> = items.iter().enumerate().map(number).collect();
        let numbers: Option<Vec<f64>> = numbers.into_iter().collect();
        numbers.filter(|numbers| !numbers.is_empty())
    }

    /// The string at `key`, if it is a single line: not empty, and without control characters.
    #[must_use]
    pub fn line(&self, key: &str) -> Option<String> {
        let breaks = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
        self.parsed(key, "a non-empty string of one line", |text| {
            let is_line = !text.trim().is_empty() && !text.contains(breaks);
            is_line.then(|| text.to_owned())
        })
    }

    /// The string at `key` as `parse` reads it; `None` from `parse` means that it is not `allowed`.
    #[must_use]
    pub fn parsed<T>(
        &self,
        key: &str,
        allowed: &str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> Option<T> {
        let value = match self.node(key).map(|node| &node.value) {
            Some(Value::Text(value)) => parse(value),
            _ => None,
        };
        self.checked(value, key, || allowed.to_owned())
    }

    /// The value that the string at `key` names, if it is one of `names`.
    #[must_use]
    pub fn choice<T: Copy>(&self, key: &str, names: &[(&str, T)]) -> Option<T> {
        let node = self.node(key);
        let word = match node.map(|node| &node.value) {
            Some(Value::Text(value)) => value.as_str(),
            _ => "",
        };
        let chosen = names.iter().find(|(name, _)| *name == word);
        if chosen.is_none() {
            let value = node.map(|node| node.value.to_string());
            let names = names.iter().map(|(name, _)| *name);
            self.report(
                key,
                InputError::not_one_of(self.path_of(key), value, word, names),
            );
        }
        chosen.map(|(_, value)| *value)
    }

    /// Reports that the value at `key` is not what is `allowed`, or missing.
    pub fn error(&self, key: &str, allowed: &str) {
        self.error_for(key, allowed, None);
    }

    /// As [`Section::error`], with a suggestion.
    pub fn error_for(&self, key: &str, allowed: &str, suggestion: Option<String>) {
        let value = self.node(key).map(|node| node.value.to_string());
        let error = InputError::new(self.path_of(key), value, allowed.to_owned());
        self.report(
            key,
            InputError {
                suggestion,
                ..error
            },
        );
    }

    fn checked<T>(&self, value: Option<T>, key: &str, allowed: impl Fn() -> String) -> Option<T> {
        if value.is_none() && !self.has_old_name_of(key) {
            self.error(key, &allowed());
        }
        value
    }

    /// Whether the value at `key` stands under the key of an earlier version, which is an error of its
    /// own.
    fn has_old_name_of(&self, key: &str) -> bool {
        !self.has(key) && self.keys().any(|old| renamed::key(old, [key]).is_some())
    }

    /// Records an error of the value at `key`, unless the section as a whole is one.
    pub(crate) fn report(&self, key: &str, error: InputError) {
        let origin = self.origin(key);
        if !self.is_invalid {
            self.errors.borrow_mut().push(InputError {
                origin: Some(origin.to_owned()),
                ..error
            });
        }
    }

    fn node(&self, key: &str) -> Option<&'d Node> {
        self.table?.get(key)
    }

    /// The path of `key`.
    pub(crate) fn path_of(&self, key: &str) -> String {
        path_of(&self.path, key)
    }
}

fn as_table(node: &Node) -> Option<&Table> {
    match &node.value {
        Value::Table(table) => Some(table),
        _ => None,
    }
}
