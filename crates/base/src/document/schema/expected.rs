//! What a schema allows, as text for error messages and the reference.

use super::forms::{choices, forms, name_at, open_choices, tag};
use super::keywords::{Object, alternatives, list};
use super::simplified::Schema;
use super::units::unit;
use crate::document::node::written;
use serde_json::Value as Json;

impl Schema {
    /// What `part` of the schema allows, as a noun phrase: "a number from 0 to 100 (metres)".
    #[must_use]
    pub fn expected(&self, part: &Json) -> String {
        expected(self, part)
    }
}

pub(super) fn expected(schema: &Schema, part: &Json) -> String {
    if let Some(names) = choices(schema, part) {
        let names = quoted(&names);
        return match &names[..] {
            [only] => only.clone(),
            _ => format!("one of {}", names.join(", ")),
        };
    }
    let Some(keywords) = schema.keywords(part) else {
        return "a value".to_owned();
    };
    if let Some((names, table)) = open_choices(schema, keywords) {
        let names = quoted(&names).join(", ");
        return format!("one of {names}, or a name in `{table}`");
    }
    if !alternatives(keywords).is_empty() {
        return union(schema, part);
    }
    match keywords.get("type").and_then(Json::as_str) {
        Some("object") => table(keywords),
        Some("array") => list_words(schema, keywords) + &unit(part, keywords),
        Some("boolean") => "true or false".to_owned(),
        Some("string") if keywords.contains_key("minLength") => "a non-empty string".to_owned(),
        Some("string") => "a string".to_owned(),
        Some("integer") => format!("a whole number{}", range(keywords)) + &unit(part, keywords),
        Some("number") => format!("a number{}", range(keywords)) + &unit(part, keywords),
        _ => "a value".to_owned(),
    }
}

fn union<'s>(schema: &'s Schema, part: &'s Json) -> String {
    let forms = forms(schema, part);
    let tag = tag(schema, &forms);
    let name_of = |form: &&'s Json| name_at(schema, form, tag?);
    let names: Vec<&str> = forms.iter().filter_map(name_of).collect();
    let mut all: Vec<String> = Vec::new();
    for form in forms.iter().filter(|form| name_of(form).is_none()) {
        all.push(expected(schema, form));
    }
    if let Some(tag) = tag {
        all.push(format!("a table with {tag} = {}", or(&quoted(&names))));
    }
    or(&all)
}

fn table(keywords: &Object) -> String {
    let required = list(keywords, "required").iter().filter_map(Json::as_str);
    match required.collect::<Vec<_>>()[..] {
        [] => "a table".to_owned(),
        [one] => format!("a table with {one}"),
        [ref first @ .., last] => format!("a table with {} and {last}", first.join(", ")),
    }
}

fn list_words(schema: &Schema, keywords: &Object) -> String {
    let bound = |key| keywords.get(key).and_then(Json::as_u64);
    let number = match (bound("minItems"), bound("maxItems")) {
        (Some(low), Some(high)) if low == high => format!("{low} "),
        (Some(low), Some(high)) => format!("{low} to {high} "),
        (Some(low), None) => format!("at least {low} "),
        (None, Some(high)) => format!("at most {high} "),
        (None, None) => String::new(),
    };
    let each = keywords.get("items").map(|items| plural(schema, items));
    format!("a list of {number}{}", each.unwrap_or("values".to_owned()))
}

fn plural(schema: &Schema, part: &Json) -> String {
    let Some(keywords) = schema.keywords(part) else {
        return "values".to_owned();
    };
    match keywords.get("type").and_then(Json::as_str) {
        Some("number") => format!("numbers{}", range(keywords)),
        Some("integer") => format!("whole numbers{}", range(keywords)),
        Some("array") => list_words(schema, keywords).replacen("a list", "lists", 1),
        Some("string") => "strings".to_owned(),
        Some("object") => table(keywords).replacen("a table", "tables", 1),
        _ => format!("values, each {}", expected(schema, part)),
    }
}

fn range(keywords: &Object) -> String {
    let bound = |key| keywords.get(key).and_then(Json::as_f64).map(written);
    let low = bound("minimum").map(|low| ("at least", low));
    let low = low.or_else(|| Some(("above", bound("exclusiveMinimum")?)));
    let high = bound("maximum").map(|high| ("at most", high));
    let high = high.or_else(|| Some(("below", bound("exclusiveMaximum")?)));
    match (low, high) {
        (Some(("at least", low)), Some(("at most", high))) => format!(" from {low} to {high}"),
        (Some((from, low)), Some((to, high))) => format!(" {from} {low} and {to} {high}"),
        (Some((word, bound)), None) | (None, Some((word, bound))) => {
            let of = if word.starts_with("at") { "of " } else { "" };
            format!(" {of}{word} {bound}")
        }
        (None, None) => String::new(),
    }
}

fn quoted(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| format!("{name:?}")).collect()
}

/// "a, b or c".
fn or(all: &[String]) -> String {
    match all {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        _ => all.concat(),
    }
}
