//! Converts a schema to the simplified form.

use super::keywords::{Object, list};
use super::units::annotate;
use schemars::Schema;
use schemars::transform::{Transform, transform_subschemas};
use serde_json::{Value as Json, json};

/// Where schemars puts the schemas of named types.
const DEFINITIONS: &str = "definitions";

/// Keywords of compositions.
const PARTS: [&str; 4] = ["$ref", "oneOf", "anyOf", "allOf"];

/// `schema` in the simplified form, with units.
pub(super) fn closed(mut schema: Schema) -> Json {
    let definitions = schema.get(DEFINITIONS).cloned();
    let definitions = match definitions {
        Some(Json::Object(definitions)) => definitions,
        _ => Object::new(),
    };
    Close { definitions }.transform(&mut schema);
    let mut schema = schema.to_value();
    annotate(&mut schema);
    schema
}

struct Close {
    /// The original definitions.
    definitions: Object,
}

impl Transform for Close {
    fn transform(&mut self, schema: &mut Schema) {
        if let Some(object) = schema.as_object_mut() {
            drop_null(object);
            self.compose(object);
            bound(object);
            close(object);
            join_lines(object);
            if let Some(items) = object.remove("prefixItems") {
                object.insert("items".to_owned(), items);
            }
        }
        transform_subschemas(self, schema);
    }
}

/// TOML has no null: nullable values are optional.
fn drop_null(schema: &mut Object) {
    let is_null = |part: &Json| part.is_null() || part == "null" || part["type"] == "null";
    for key in ["type", "enum", "anyOf", "oneOf"] {
        if let Some(Json::Array(parts)) = schema.get_mut(key) {
            parts.retain(|part| !is_null(part));
        }
    }
    if let [only] = list(schema, "type") {
        let only = only.clone();
        schema.insert("type".to_owned(), only);
    }
    if let [Json::Object(only)] = list(schema, "anyOf") {
        let only = only.clone();
        schema.remove("anyOf");
        *schema = union(schema.clone(), &only);
    }
    if let Some(default) = schema.get_mut("default") {
        drop_null_values(default);
        if default.is_null() {
            schema.remove("default");
        }
    }
}

fn drop_null_values(value: &mut Json) {
    match value {
        Json::Object(table) => {
            table.retain(|_, value| !value.is_null());
            table.values_mut().for_each(drop_null_values);
        }
        Json::Array(items) => items.iter_mut().for_each(drop_null_values),
        _ => {}
    }
}

impl Close {
    /// Writes out composed objects, which come from `#[serde(flatten)]` and tagged enums.
    fn compose(&self, schema: &mut Object) {
        let has_parts = PARTS.iter().any(|key| schema.contains_key(*key));
        let is_composed =
            schema.contains_key("properties") && has_parts || schema.contains_key("allOf");
        if !is_composed {
            return;
        }
        let mut variants = self.variants(schema);
        let default = schema.get("default").cloned();
        if variants.len() == 1 {
            *schema = variants.remove(0);
        } else {
            schema.retain(|key, _| key == "description" || key == DEFINITIONS);
            schema.insert("oneOf".to_owned(), json!(variants));
        }
        schema.extend(default.map(|default| ("default".to_owned(), default)));
    }

    /// All forms of a composed object, without compositions.
    fn variants(&self, schema: &Object) -> Vec<Object> {
        let mut own = schema.clone();
        own.retain(|key, _| !PARTS.contains(&key.as_str()) && key != "default");
        let mut made = vec![own];
        let target = schema.get("$ref").and_then(|target| self.target(target));
        let all = list(schema, "allOf").iter().filter_map(Json::as_object);
        for part in target.into_iter().chain(all) {
            made = joined(&made, &self.variants(part), |own, part| {
                union(own.clone(), part)
            });
        }
        for key in ["oneOf", "anyOf"] {
            let parts = list(schema, key).iter().filter_map(Json::as_object);
            let parts: Vec<Object> = parts.flat_map(|part| self.variants(part)).collect();
            if !parts.is_empty() {
                // The keywords of a variant take precedence over those of the whole.
                made = joined(&made, &parts, |own, part| union(part.clone(), own));
            }
        }
        made
    }

    fn target(&self, reference: &Json) -> Option<&Object> {
        let name = reference.as_str()?.strip_prefix("#/definitions/")?;
        self.definitions.get(name)?.as_object()
    }
}

fn joined(left: &[Object], right: &[Object], join: fn(&Object, &Object) -> Object) -> Vec<Object> {
    let with_each = |one| right.iter().map(move |other| join(one, other));
    left.iter().flat_map(with_each).collect()
}

/// The union of both; the `first` takes precedence.
fn union(mut first: Object, second: &Object) -> Object {
    for (key, value) in second {
        match (first.get_mut(key), value) {
            (Some(Json::Object(mine)), Json::Object(others)) if key == "properties" => {
                *mine = union(mine.clone(), others);
            }
            (Some(Json::Array(mine)), Json::Array(others)) if key == "required" => {
                mine.extend(others.iter().cloned());
            }
            (Some(_), _) => {}
            (None, value) => {
                first.insert(key.clone(), value.clone());
            }
        }
    }
    first
}

/// Replaces Rust's integer formats by bounds.
fn bound(schema: &mut Object) {
    let format = schema.remove("format");
    let (low, high) = match format.as_ref().and_then(Json::as_str) {
        Some("uint32") => (json!(0), json!(u32::MAX)),
        Some("int32") => (json!(i32::MIN), json!(i32::MAX)),
        Some("uint" | "uint64") => (json!(0), json!(i64::MAX)),
        _ => return,
    };
    schema.entry("minimum").or_insert(low);
    schema.entry("maximum").or_insert(high);
}

fn close(schema: &mut Object) {
    if schema.get("type").is_some_and(|name| name == "object") {
        let others = schema.entry("additionalProperties");
        others.or_insert(Json::Bool(false));
    }
}

/// Joins the lines of each paragraph.
fn join_lines(schema: &mut Object) {
    if let Some(Json::String(text)) = schema.get_mut("description") {
        let paragraphs = text
            .split("\n\n")
            .map(|paragraph| paragraph.replace('\n', " "));
        *text = paragraphs.collect::<Vec<_>>().join("\n\n");
    }
}
