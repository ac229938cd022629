//! Which of several forms a value was meant to have, so that its errors are those of that form.

use super::check::Check;
use super::words::choices;
use super::{Object, Schema, alternatives};
use crate::document::{Node, Table, Value, path_of};
use crate::error::{InputError, nearest};
use serde_json::Value as Json;
use std::cmp::Reverse;

impl<'s> Check<'s> {
    /// Tells what is wrong with `node` as the alternative of `schema` that was meant.
    pub(super) fn union(&mut self, schema: &'s Json, node: &Node, path: &str) {
        let forms = forms(self.schema, schema);
        if let (Value::Table(table), Some(tag)) = (&node.value, tag(self.schema, &forms)) {
            return self.tagged(&forms, (tag, table), (node, path));
        }
        let errors_as = |form: &'s Json| {
            let mut check = Check::new(self.schema);
            check.value(form, node, path);
            check.errors
        };
        let alike = forms.into_iter().filter_map(|form| {
            let likeness = likeness(self.schema, form, node)?;
            Some((likeness, errors_as(form)))
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

    /// The value of the key `tag` says which form is meant.
    fn tagged(
        &mut self,
        forms: &[&'s Json],
        (tag, table): (&str, &Table),
        (node, path): (&Node, &str),
    ) {
        let name_of = |form: &&'s Json| name_at(self.schema, form, tag);
        let names: Vec<&str> = forms.iter().filter_map(name_of).collect();
        let path_of_tag = path_of(path, tag);
        let Some(given) = table.get(tag) else {
            let error = InputError::not_one_of(path_of_tag, None, "", names.into_iter());
            return self.push(node, error);
        };
        let is_meant = |form: &&&'s Json| {
            name_of(form).is_some_and(|name| given.value == Value::Text(name.to_owned()))
        };
        match forms.iter().find(is_meant) {
            Some(form) => self.value(form, node, path),
            None => self.choice(&names, given, &path_of_tag),
        }
    }
}

/// The alternatives of `schema`, and those of each that is again a choice of alternatives.
pub(super) fn forms<'s>(schema: &'s Schema, union: &'s Json) -> Vec<&'s Json> {
    let parts = schema.keywords(union).map_or(&[][..], alternatives);
    let parts = parts.iter().flat_map(|part| {
        let is_union = choices(schema, part).is_none()
            && schema
                .keywords(part)
                .is_some_and(|keywords| !alternatives(keywords).is_empty());
        if is_union {
            forms(schema, part)
        } else {
            vec![part]
        }
    });
    parts.collect()
}

/// The key whose value tells which of the forms a table has, if there is one.
pub(super) fn tag<'s>(schema: &'s Schema, forms: &[&'s Json]) -> Option<&'s str> {
    let mut tables = forms
        .iter()
        .filter(|form| properties(schema, form).is_some());
    let first = properties(schema, tables.next()?)?;
    let is_tag = |key: &&String| {
        let has_name = |form: &&'s Json| name_at(schema, form, key).is_some();
        let mut tables = forms
            .iter()
            .filter(|form| properties(schema, form).is_some());
        tables.all(has_name)
    };
    first.keys().find(is_tag).map(String::as_str)
}

/// The only text that may stand at `key` of a table of this form.
pub(super) fn name_at<'s>(schema: &'s Schema, form: &'s Json, key: &str) -> Option<&'s str> {
    match choices(schema, properties(schema, form)?.get(key)?)?[..] {
        [name] => Some(name),
        _ => None,
    }
}

fn properties<'s>(schema: &'s Schema, form: &'s Json) -> Option<&'s Object> {
    schema.keywords(form)?.get("properties")?.as_object()
}

/// How much `node` looks like this form, if at all: for a table, by its keys that are known or
/// nearly so.
fn likeness(schema: &Schema, form: &Json, node: &Node) -> Option<usize> {
    let name = schema
        .keywords(form)
        .and_then(|keywords| keywords.get("type")?.as_str());
    let is_alike = match (&node.value, name) {
        (Value::Table(table), Some("object")) => {
            let Some(known) = properties(schema, form) else {
                return Some(1);
            };
            let is_known = |key: &&String| nearest(key, known.keys().map(String::as_str)).is_some();
            return Some(table.keys().filter(is_known).count());
        }
        (Value::List(_), Some("array"))
        | (Value::Bool(_), Some("boolean"))
        | (Value::Text(_), Some("string"))
        | (Value::Integer(_) | Value::Float(_), Some("number" | "integer")) => true,
        (Value::Text(_), None) => choices(schema, form).is_some(),
        _ => false,
    };
    is_alike.then_some(1)
}
