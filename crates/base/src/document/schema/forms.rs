//! The alternatives of a schema: a list of names, or several forms of which a value has one.

use super::keywords::{NAMES, Object, alternatives, list};
use super::simplified::Schema;
use crate::document::node::{Node, Value};
use crate::document::renamed;
use crate::error::nearest;
use serde_json::Value as Json;

/// The strings that `part` allows, if it allows nothing else.
pub(super) fn choices<'s>(schema: &'s Schema, part: &'s Json) -> Option<Vec<&'s str>> {
    let keywords = schema.keywords(part)?;
    if let Some(only) = keywords.get("const") {
        return Some(vec![only.as_str()?]);
    }
    let names = list(keywords, "enum");
    if !names.is_empty() {
        return names.iter().map(Json::as_str).collect();
    }
    let parts = alternatives(keywords);
    let names: Option<Vec<_>> = parts.iter().map(|part| choices(schema, part)).collect();
    names
        .filter(|names| !names.is_empty())
        .map(|names| names.concat())
}

/// The names that `keywords` list beside those of a table of the document, and the name of that table.
pub(super) fn open_choices<'s>(
    schema: &'s Schema,
    keywords: &'s Object,
) -> Option<(Vec<&'s str>, &'s str)> {
    let table = keywords.get(NAMES)?.as_str()?;
    let listed = alternatives(keywords).iter();
    let listed = listed.filter_map(|part| choices(schema, part));
    Some((listed.flatten().collect(), table))
}

/// The alternatives of `schema`, with nested alternatives expanded.
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

/// The key whose value identifies the form of a table, if there is one (`kind`).
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

/// The only string allowed at `key` in a table of this form.
pub(super) fn name_at<'s>(schema: &'s Schema, form: &'s Json, key: &str) -> Option<&'s str> {
    match choices(schema, properties(schema, form)?.get(key)?)?[..] {
        [name] => Some(name),
        _ => None,
    }
}

fn properties<'s>(schema: &'s Schema, form: &'s Json) -> Option<&'s Object> {
    schema.keywords(form)?.get("properties")?.as_object()
}

/// How similar `node` is to this form, if at all. For a table: the number of its keys that the
/// form has, up to spelling.
pub(super) fn likeness(schema: &Schema, form: &Json, node: &Node) -> Option<usize> {
    let name = schema
        .keywords(form)
        .and_then(|keywords| keywords.get("type")?.as_str());
    let is_alike = match (&node.value, name) {
        (Value::Table(table), Some("object")) => {
            let Some(known) = properties(schema, form) else {
                return Some(1);
            };
            let is_known = |key: &&String| {
                let known = || known.keys().map(String::as_str);
                nearest(key, known())
                    .or_else(|| renamed::key(key, known()))
                    .is_some()
            };
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
