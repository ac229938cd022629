//! Errors of models as a whole. Names of models that do not exist are errors of the schema.

use super::chain::{MAX_MODELS, chain, model_of, models, table};
use crate::bodies::models::Model;
use base::document::{Document, Node, Table, Value, path_of};
use base::error::{InputError, nearest};
use std::collections::BTreeSet;

/// Maximum number of values of all models: every kind and model based on one copies its values.
const MAX_VALUES: usize = 10_000;

/// Models that are too many, that have the name of a bundled one, that are based on themselves, or that only an
/// option refers to.
pub(crate) fn errors(document: &Document) -> Vec<InputError> {
    let Some(models) = models(document) else {
        return Vec::new();
    };
    let at = document.place().key("models");
    if !are_few(models) {
        let allowed = format!("at most {MAX_MODELS} models of {MAX_VALUES} values together");
        return vec![at.error(allowed)];
    }
    let mut errors = unknown(document, models);
    for (name, model) in models {
        if Model::named(name).is_some() {
            let allowed = "under another name: this is the name of a bundled model";
            errors.push(at.key(name).error(allowed));
        }
        let chain = chain(&model.value, models);
        if chain.contains(&name.as_str()) {
            let all: Vec<&str> = std::iter::once(name.as_str()).chain(chain).collect();
            let at = at.key(name).key("model");
            let cycle = all.join(" -> ");
            errors.push(at.error(format!("a model that is not based on this one: {cycle}")));
        }
    }
    errors
}

/// Values that an option sets in a model that the scenario does not have, usually by a typing error: unlike other
/// new entries, a new model lacks nothing.
fn unknown(document: &Document, models: &Table) -> Vec<InputError> {
    let created = document.created_tables().iter();
    let created: Vec<&[String]> = created
        .filter(|created| {
            created.place <= 1 && created.path.len() > 2 && created.path[0] == "models"
        })
        .map(|created| &created.path[..])
        .collect();
    let new: BTreeSet<&String> = created.iter().map(|path| &path[1]).collect();
    let tables = [Some(models), table(document, "robots")];
    let used = tables.into_iter().flatten().flat_map(Table::values);
    let used: Vec<&Value> = used.filter_map(|node| model_of(&node.value)).collect();
    let known: Vec<&str> = models
        .keys()
        .filter(|name| !new.contains(name))
        .map(String::as_str)
        .collect();
    let is_unused = |path: &&[String]| !used.contains(&&Value::Text(path[1].clone()));
    let unused = created.into_iter().filter(is_unused);
    unused
        .filter_map(|path| Some(unknown_model(path, document.get(&keys(path))?, &known)))
        .collect()
}

fn keys(path: &[String]) -> Vec<&str> {
    path.iter().map(String::as_str).collect()
}

/// The error of a value at a path through a model that is none of those `known`.
fn unknown_model(path: &[String], node: &Node, known: &[&str]) -> InputError {
    let path_in = |name: &str| {
        let mut path = keys(path);
        path[1] = name;
        path.iter()
            .fold(String::new(), |path, key| path_of(&path, key))
    };
    let allowed = match known {
        [] => "in an existing entry of models, which is empty".to_owned(),
        _ => format!("in an existing entry of models: {}", known.join(", ")),
    };
    let error = InputError::new(path_in(&path[1]), Some(node.value.to_string()), allowed);
    InputError {
        origin: Some(node.origin.clone()),
        suggestion: nearest(&path[1], known.iter().copied()).map(path_in),
        ..error
    }
}

/// Whether models are few and small enough to complete others from them.
pub(super) fn are_few(models: &Table) -> bool {
    let mut values = MAX_VALUES;
    models.len() <= MAX_MODELS && models.values().all(|model| has_room(model, &mut values))
}

/// Whether a node has at most this number of values, of which it takes its own.
fn has_room(node: &Node, values: &mut usize) -> bool {
    match &node.value {
        Value::Table(table) => table.values().all(|inner| has_room(inner, values)),
        Value::List(items) => items.iter().all(|inner| has_room(inner, values)),
        _ => {
            let has_room = *values > 0;
            *values = values.saturating_sub(1);
            has_room
        }
    }
}
