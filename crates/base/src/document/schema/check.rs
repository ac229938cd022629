//! Checks a document against its schema and collects the errors.

use super::expected::expected;
use super::forms::{choices, forms, likeness, name_at, open_choices, tag};
use super::keywords::{Object, alternatives, list};
use super::simplified::Schema;
use crate::document::node::{Node, Table, Value, as_number, path_of};
use crate::document::renamed::{self, unknown_key};
use crate::document::root::Document;
use crate::error::InputError;
use serde_json::Value as Json;
use std::cmp::Reverse;

impl Schema {
    /// All errors of `document`.
    #[must_use]
    pub fn errors(&self, document: &Document) -> Vec<InputError> {
        let mut check = Check::new(self, &document.root);
        check.value(&self.root, &document.root, "");
        check.errors
    }
}

pub(super) struct Check<'s> {
    pub(super) schema: &'s Schema,
    /// The document.
    root: &'s Node,
    errors: Vec<InputError>,
}

impl<'s> Check<'s> {
    pub(super) fn new(schema: &'s Schema, root: &'s Node) -> Self {
        Self {
            schema,
            root,
            errors: Vec::new(),
        }
    }

    /// Checks `node`, which is at `path`, and everything in it.
    fn value(&mut self, schema: &'s Json, node: &Node, path: &str) {
        let Some(keywords) = self.schema.keywords(schema) else {
            return;
        };
        if let Some(names) = self.names(schema) {
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

    /// The names that `schema` allows in this document, if it allows nothing else.
    pub(super) fn names(&self, schema: &'s Json) -> Option<Vec<&'s str>> {
        let keywords = self.schema.keywords(schema)?;
        let Some((mut names, table)) = open_choices(self.schema, keywords) else {
            return choices(self.schema, schema);
        };
        if let Value::Table(root) = &self.root.value
            && let Some(Value::Table(table)) = root.get(table).map(|node| &node.value)
        {
            names.extend(table.keys().map(String::as_str));
        }
        Some(names)
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
        // A key under its old name may be what is missing, or make up for it as `model` does.
        let names = || known.into_iter().flat_map(Object::keys).map(String::as_str);
        let is_old = |key: &String| renamed::key(key, names()).is_some();
        if table.keys().any(is_old) {
            return;
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

    /// Checks `node` against the alternative of `schema` that it resembles most, so that the errors are
    /// those of the intended form.
    fn union(&mut self, schema: &'s Json, node: &Node, path: &str) {
        let forms = forms(self.schema, schema);
        if let (Value::Table(table), Some(tag)) = (&node.value, tag(self.schema, &forms)) {
            return self.tagged(&forms, (tag, table), (node, path));
        }
        let alike = forms.into_iter().filter_map(|form| {
            let likeness = likeness(self.schema, form, node)?;
            Some((likeness, self.errors_as(form, node, path)))
        });
        let meant = alike.min_by_key(|(likeness, errors)| {
            (!errors.is_empty(), Reverse(*likeness), errors.len())
        });
        match meant {
            Some((likeness, errors)) if likeness > 0 || errors.is_empty() => {
                self.errors.extend(errors);
            }
            _ => self.error(schema, node, path),
        }
    }

    /// The errors of `node` as a value of this `form`.
    pub(super) fn errors_as(&self, form: &'s Json, node: &Node, path: &str) -> Vec<InputError> {
        let mut check = Check::new(self.schema, self.root);
        check.value(form, node, path);
        check.errors
    }

    /// Checks a table whose key `tag` names its form.
    fn tagged(
        &mut self,
        forms: &[&'s Json],
        (tag, table): (&str, &Table),
        (node, path): (&Node, &str),
    ) {
        let name_of = |form: &&'s Json| name_at(self.schema, form, tag);
        let names: Vec<&str> = forms.iter().filter_map(name_of).collect();
        let path_of_tag = path_of(path, tag);
        let Some(kind) = table.get(tag) else {
            let error = InputError::not_one_of(path_of_tag, None, "", names.into_iter());
            return self.push(node, error);
        };
        let is_meant = |form: &&&'s Json| {
            name_of(form).is_some_and(|name| kind.value == Value::Text(name.to_owned()))
        };
        match forms.iter().find(is_meant) {
            Some(form) => self.value(form, node, path),
            None => self.choice(&names, kind, &path_of_tag),
        }
    }

    /// Checks that `node` is one of the `names`.
    fn choice(&mut self, names: &[&str], node: &Node, path: &str) {
        let word = match &node.value {
            Value::Text(text) => text.as_str(),
            _ => "",
        };
        if !names.contains(&word) {
            let (path, value) = (path.to_owned(), Some(node.value.to_string()));
            let names = names.iter().copied();
            let error = match renamed::value(word, names.clone()) {
                Some(new) => InputError::renamed(path, value, format!("{new:?}")),
                None => InputError::not_one_of(path, value, word, names),
            };
            self.push(node, error);
        }
    }

    /// Reports that `node` is not what `schema` allows.
    fn error(&mut self, schema: &Json, node: &Node, path: &str) {
        let allowed = expected(self.schema, schema);
        let error = InputError::new(path.to_owned(), Some(node.value.to_string()), allowed);
        self.push(node, error);
    }

    /// Reports that the table `node` at `path` lacks `key`.
    fn missing(&mut self, schema: &Json, (key, node): (&str, &Node), path: &str) {
        let allowed = expected(self.schema, schema);
        self.push(node, InputError::new(path_of(path, key), None, allowed));
    }

    /// Reports that the table at `path` has a `key` that is none of the `known`.
    fn unknown_key<'k>(
        &mut self,
        known: impl Iterator<Item = &'k str> + Clone,
        (key, node): (&str, &Node),
        path: &str,
    ) {
        let value = node.value.to_string();
        self.push(node, unknown_key(path, key, value, known));
    }

    fn push(&mut self, node: &Node, error: InputError) {
        let origin = Some(node.origin.clone());
        self.errors.push(InputError { origin, ..error });
    }
}

/// Whether `node` is the plain value of type `name` that `keywords` allow.
fn is_plain(name: &str, keywords: &Object, node: &Node) -> bool {
    match (name, &node.value) {
        ("boolean", Value::Bool(_)) => true,
        ("string", Value::Text(text)) => {
            let min = keywords.get("minLength").and_then(Json::as_u64);
            text.chars().count() as u64 >= min.unwrap_or(0)
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
