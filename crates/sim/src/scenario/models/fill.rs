//! Completes robot kinds and models from the models that they are based on.

use super::chain::{chain, model_of, models, table};
use super::errors::are_few;
use crate::bodies::models::Model;
use base::document::{Document, Node, Table, Value};
use std::collections::BTreeMap;

/// Completes the tables of `robots` and `models` in `document`. Values there are kept; tables are merged
/// key by key, except for those of another `kind`.
///
/// Wrong names of models are reported elsewhere: kinds with such a model are completed from a bundled one, so
/// that the keys that their model would have are not reported as missing.
pub(crate) fn fill(document: &mut Document) {
    let own = models(document).filter(|own| are_few(own)).cloned();
    let own = own.unwrap_or_default();
    let mut complete = BTreeMap::new();
    for (name, model) in &own {
        let mut names = chain(&model.value, &own);
        names.insert(0, name);
        for name in names.into_iter().rev() {
            if !complete.contains_key(name) {
                let model = completed(&own[name], &complete);
                complete.insert(name.to_owned(), model);
            }
        }
    }
    for (name, model) in &complete {
        document.fill(&["models", name], model);
    }
    let kinds = table(document, "robots").into_iter().flatten();
    let based =
        kinds.filter_map(|(name, kind)| Some((name.clone(), model_of(&kind.value)?.clone())));
    for (name, model) in based.collect::<Vec<_>>() {
        document.fill(&["robots", &name], &base(&model, &complete));
    }
}

/// A model, completed from one that is complete.
fn completed(model: &Node, complete: &BTreeMap<String, Document>) -> Document {
    let table = match &model.value {
        Value::Table(table) => table.clone(),
        _ => Table::new(),
    };
    let mut completed = Document::of_table(table, &model.origin);
    if let Some(model) = model_of(&model.value) {
        completed.fill(&[], &base(model, complete));
    }
    completed
}

/// The values of the model with this name, of which each may be missing.
fn base(name: &Value, complete: &BTreeMap<String, Document>) -> Document {
    let Value::Text(name) = name else {
        return bundled("");
    };
    complete.get(name).cloned().unwrap_or_else(|| bundled(name))
}

/// A bundled model; any, if there is none of this name.
fn bundled(name: &str) -> Document {
    let found = Model::named(name).map(|model| (name, model));
    let (name, model) = found.unwrap_or(("ugv", Model::Ugv));
    // A test checks that each is valid TOML.
    Document::parse(&format!("bundled model {name}"), model.text()).unwrap_or_default()
}
