//! The parameters of a document: the numbers, switches and choices that its schema allows.

use super::check::Check;
use super::forms::forms;
use super::keywords::Object;
use super::simplified::Schema;
use crate::document::node::{Node, Table, Value};
use crate::document::root::Document;
use ParameterValue::{Switch, Text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Number, Value as Json};

/// Maximum number of keys of a parameter: a schema may contain itself.
const MAX_STEPS: usize = 32;

/// A number, switch or choice of a scenario.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Parameter {
    /// Its keys from the root; numbers are places in lists.
    pub steps: Vec<PathStep>,
    /// Its value; null if the scenario does not set it.
    pub value: Option<ParameterValue>,
    /// Its default, if any.
    pub default: Option<ParameterValue>,
    /// The lower bound, if any.
    pub low: Option<Number>,
    /// The upper bound, if any.
    pub high: Option<Number>,
    /// The kind of its values.
    pub kind: ParameterKind,
    /// The choices; null if it is a number.
    pub values: Option<Vec<ParameterValue>>,
    /// The unit, if any.
    pub unit: Option<String>,
    /// The description.
    pub help: String,
}

/// A key of a table, or a place in a list.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum PathStep {
    /// A key.
    Key(String),
    /// A place, from 0.
    Index(usize),
}

/// A value of a parameter.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ParameterValue {
    /// A number.
    Number(Number),
    /// A choice by name.
    Text(String),
    /// A switch.
    Switch(bool),
}

/// The kind of a parameter's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ParameterKind {
    /// Whole numbers.
    Whole,
    /// Numbers.
    Real,
    /// Names or switches.
    Choice,
}

impl Schema {
    /// The parameters of a valid `document`, in the order of the schema: those that it sets, and those that it can set
    /// without a choice among several forms.
    #[must_use]
    pub fn parameters(&self, document: &Document) -> Vec<Parameter> {
        let mut walk = Walk {
            check: Check::new(self, &document.root),
            found: Vec::new(),
        };
        walk.value(&self.root, Some(&document.root), &[]);
        walk.found
    }
}

struct Walk<'s> {
    check: Check<'s>,
    found: Vec<Parameter>,
}

impl<'s> Walk<'s> {
    /// Adds the parameters of the value `node` that `part` describes, which may be missing.
    fn value(&mut self, part: &'s Json, node: Option<&Node>, steps: &[PathStep]) {
        if steps.len() > MAX_STEPS {
            return;
        }
        let Some(form) = self.form(part, node) else {
            return;
        };
        let Some(keywords) = self.check.schema.keywords(form) else {
            return;
        };
        match (keywords.get("type").and_then(Json::as_str), node) {
            (Some("object"), _) => self.table(keywords, node, steps),
            (Some("array"), Some(node)) => self.list(keywords, node, steps),
            _ => self.found.extend(self.parameter([part, form], node, steps)),
        }
    }

    /// The form of `part` that `node` has; without it, the one that is a single value.
    fn form(&self, part: &'s Json, node: Option<&Node>) -> Option<&'s Json> {
        let schema = self.check.schema;
        let is_typed = schema.keywords(part)?.contains_key("type");
        let forms = forms(schema, part);
        if is_typed || forms.is_empty() || self.check.names(part).is_some() {
            return Some(part);
        }
        forms.into_iter().find(|form| match node {
            Some(node) => self.check.errors_as(form, node, "").is_empty(),
            None => self.parameter([part, form], None, &[]).is_some(),
        })
    }

    /// Keys with a dot are left out: no path with dots can name them.
    fn table(&mut self, keywords: &'s Object, node: Option<&Node>, steps: &[PathStep]) {
        let table = match node.map(|node| &node.value) {
            Some(Value::Table(table)) => Some(table),
            _ => None,
        };
        let known = keywords.get("properties").and_then(Json::as_object);
        let others = keywords.get("additionalProperties");
        let others = others.filter(|others| others.is_object());
        let mut keys: Vec<(&String, &'s Json)> = known.into_iter().flatten().collect();
        for name in table.into_iter().flat_map(Table::keys) {
            let is_new = known.is_none_or(|known| !known.contains_key(name));
            keys.extend(others.filter(|_| is_new).map(|others| (name, others)));
        }
        keys.retain(|(key, _)| !key.contains('.'));
        for (key, part) in keys {
            let steps = [steps, &[PathStep::Key(key.clone())]].concat();
            self.value(part, table.and_then(|table| table.get(key)), &steps);
        }
    }

    /// Of lists of lists, none are parameters.
    fn list(&mut self, keywords: &'s Object, node: &Node, steps: &[PathStep]) {
        let (Some(part), Value::List(items)) = (keywords.get("items"), &node.value) else {
            return;
        };
        let inner = self.check.schema.keywords(part);
        if inner.is_none_or(|inner| inner.get("type").is_some_and(|name| name == "array")) {
            return;
        }
        for (index, item) in items.iter().enumerate() {
            let steps = [steps, &[PathStep::Index(index)]].concat();
            self.value(part, Some(item), &steps);
        }
    }

    /// The single value that `parts` describe, a schema and the form of it that applies.
    fn parameter(
        &self,
        parts: [&'s Json; 2],
        node: Option<&Node>,
        steps: &[PathStep],
    ) -> Option<Parameter> {
        let keywords = parts.map(|part| self.check.schema.keywords(part));
        let all = [parts[0].as_object()].into_iter().chain(keywords).flatten();
        let word = |key: &str| all.clone().find_map(|part| part.get(key));
        let text = |key| word(key).and_then(Json::as_str).map(str::to_owned);
        let bound = |keys: [&str; 2]| keys.into_iter().find_map(word)?.as_number().cloned();
        let (kind, values) = match text("type").as_deref() {
            Some("integer") => (ParameterKind::Whole, None),
            Some("number") => (ParameterKind::Real, None),
            Some("boolean") => (
                ParameterKind::Choice,
                Some([false, true].map(Switch).into()),
            ),
            _ if word("const").is_some() => return None,
            _ => {
                let names = self.check.names(parts[1])?.into_iter();
                let names = names.map(|name| Text(name.to_owned()));
                (ParameterKind::Choice, Some(names.collect()))
            }
        };
        Some(Parameter {
            steps: steps.to_vec(),
            value: node.and_then(|node| value_of(&node.value)),
            default: word("default").and_then(|value| ParameterValue::deserialize(value).ok()),
            low: bound(["minimum", "exclusiveMinimum"]),
            high: bound(["maximum", "exclusiveMaximum"]),
            kind,
            values,
            unit: text("x-unit"),
            help: text("description").unwrap_or_default(),
        })
    }
}

fn value_of(value: &Value) -> Option<ParameterValue> {
    match value {
        Value::Bool(value) => Some(Switch(*value)),
        Value::Integer(value) => Some(ParameterValue::Number((*value).into())),
        Value::Float(value) => Number::from_f64(*value).map(ParameterValue::Number),
        Value::Text(value) => Some(Text(value.clone())),
        _ => None,
    }
}
