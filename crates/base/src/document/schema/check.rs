//! Walks a document along its schema and collects what is wrong.

use super::words::{choices, words};
use super::{Object, Schema, alternatives, list};
use crate::document::{Node, Table, Value, as_number, path_of};
use crate::error::{InputError, nearest};
use serde_json::Value as Json;

pub(super) struct Check<'s> {
    pub(super) schema: &'s Schema,
    pub(super) errors: Vec<InputError>,
}

impl<'s> Check<'s> {
    pub(super) fn new(schema: &'s Schema) -> Self {
        Self {
            schema,
            errors: Vec::new(),
        }
    }

    /// Tells what is wrong with `node`, which stands at `path`, and with all in it.
    pub(super) fn value(&mut self, schema: &'s Json, node: &Node, path: &str) {
        let Some(keywords) = self.schema.keywords(schema) else {
            return;
        };
        if let Some(names) = choices(self.schema, schema) {
            return self.choice(&names, node, path);
        }
        if !alternatives(keywords).is_empty() {
            return self.union(schema, node, path);
        }
        match (keywords.get("type").and_then(Json::as_str), &node.value) {
            (Some("object"), Value::Table(table)) => self.table(keywords, (table, node), path),
            (Some("array"), Value::List(items)) => self.list(schema, (items, node), path),
            (None, _) => {}
            (Some(name), _) if is_plain(name, keywords, node) => {}
            _ => self.error(schema, node, path),
        }
    }

    fn table(&mut self, keywords: &'s Object, (table, node): (&Table, &Node), path: &str) {
        let known = keywords.get("properties").and_then(Json::as_object);
        let others = keywords.get("additionalProperties");
        for (key, value) in table {
            match known.and_then(|known| known.get(key)).or(others) {
                Some(Json::Bool(false)) => {
                    let known = known.into_iter().flat_map(Object::keys).map(String::as_str);
                    self.unknown_key(known, (key, value), path);
                }
                Some(schema) => self.value(schema, value, &path_of(path, key)),
                None => {}
            }
        }
        for key in list(keywords, "required").iter().filter_map(Json::as_str) {
            if !table.contains_key(key) {
                let schema = known.and_then(|known| known.get(key));
                self.missing(schema.unwrap_or(&Json::Bool(true)), (key, node), path);
            }
        }
    }

    fn list(&mut self, schema: &'s Json, (items, node): (&[Node], &Node), path: &str) {
        let Some(keywords) = self.schema.keywords(schema) else {
            return;
        };
        let bound = |key| keywords.get(key).and_then(Json::as_u64);
        let length = items.len() as u64;
        let (low, high) = (bound("minItems"), bound("maxItems"));
        if low.is_some_and(|low| length < low) || high.is_some_and(|high| length > high) {
            self.error(schema, node, path);
        }
        let each = keywords.get("items").unwrap_or(&Json::Bool(true));
        for (index, item) in items.iter().enumerate() {
            let schema = match each {
                Json::Array(places) => places.get(index),
                every => Some(every),
            };
            if let Some(schema) = schema {
                self.value(schema, item, &format!("{path}[{index}]"));
            }
        }
    }

    /// Tells if `node` is none of the `names`.
    pub(super) fn choice(&mut self, names: &[&str], node: &Node, path: &str) {
        let word = match &node.value {
            Value::Text(text) => text.as_str(),
            _ => "",
        };
        if !names.contains(&word) {
            let given = Some(node.value.to_string());
            let names = names.iter().copied();
            let error = InputError::not_one_of(path.to_owned(), given, word, names);
            self.push(node, error);
        }
    }

    /// Tells that `node` is not what `schema` allows.
    pub(super) fn error(&mut self, schema: &Json, node: &Node, path: &str) {
        let allowed = words(self.schema, schema);
        let error = InputError::new(path.to_owned(), Some(node.value.to_string()), allowed);
        self.push(node, error);
    }

    /// Tells that the table `node` at `path` lacks `key`.
    pub(super) fn missing(&mut self, schema: &Json, (key, node): (&str, &Node), path: &str) {
        let allowed = words(self.schema, schema);
        self.push(node, InputError::new(path_of(path, key), None, allowed));
    }

    /// Tells that the table at `path` has a `key` that is none of the `known`.
    fn unknown_key<'k>(
        &mut self,
        known: impl Iterator<Item = &'k str> + Clone,
        (key, value): (&str, &Node),
        path: &str,
    ) {
        let names: Vec<&str> = known.clone().collect();
        let allowed = format!("one of the known keys here: {}", names.join(", "));
        let error = InputError::new(path_of(path, key), Some(value.value.to_string()), allowed);
        let suggestion = nearest(key, known).map(str::to_owned);
        self.push(
            value,
            InputError {
                suggestion,
                ..error
            },
        );
    }

    pub(super) fn push(&mut self, node: &Node, error: InputError) {
        let origin = Some(node.origin.clone());
        self.errors.push(InputError { origin, ..error });
    }
}

/// Whether `node` is the plain value of type `name` that `keywords` allow.
fn is_plain(name: &str, keywords: &Object, node: &Node) -> bool {
    match (name, &node.value) {
        ("boolean", Value::Bool(_)) => true,
        ("string", Value::Text(text)) => {
            let least = keywords.get("minLength").and_then(Json::as_u64);
            text.chars().count() as u64 >= least.unwrap_or(0)
        }
        ("integer", Value::Integer(_)) | ("number", Value::Integer(_) | Value::Float(_)) => {
            as_number(node).is_some_and(|number| is_in_range(keywords, number))
        }
        _ => false,
    }
}

/// Infinities and NaN are in no range.
fn is_in_range(keywords: &Object, number: f64) -> bool {
    let bound = |key| keywords.get(key).and_then(Json::as_f64);
    number.is_finite()
        && bound("minimum").is_none_or(|low| number >= low)
        && bound("maximum").is_none_or(|high| number <= high)
        && bound("exclusiveMinimum").is_none_or(|low| number > low)
        && bound("exclusiveMaximum").is_none_or(|high| number < high)
}
