//! Which models a robot kind or a model is based on.

use base::document::{Document, Table, Value};

/// Maximum number of models of a scenario.
pub(super) const MAX_MODELS: usize = 255;

/// The models of a document; `None` without any.
pub(super) fn models(document: &Document) -> Option<&Table> {
    table(document, "models")
}

/// The table at the root under this key.
pub(super) fn table<'d>(document: &'d Document, key: &str) -> Option<&'d Table> {
    match document.get(&[key]).map(|node| &node.value) {
        Some(Value::Table(table)) => Some(table),
        _ => None,
    }
}

/// The value of `model` in a table of a kind or a model.
pub(super) fn model_of(value: &Value) -> Option<&Value> {
    match value {
        Value::Table(table) => table.get("model").map(|node| &node.value),
        _ => None,
    }
}

/// The models of the scenario on which a kind or a model with this table is based: its own model first, then
/// the one on which that is based. It ends before a model that is not of the scenario, or that it has already.
pub(super) fn chain<'d>(value: &'d Value, models: &'d Table) -> Vec<&'d str> {
    let mut chain: Vec<&str> = Vec::new();
    let mut value = value;
    while chain.len() < MAX_MODELS
        && let Some(Value::Text(name)) = model_of(value)
        && let Some((name, model)) = models.get_key_value(name)
        && !chain.contains(&name.as_str())
    {
        chain.push(name);
        value = &model.value;
    }
    chain
}
