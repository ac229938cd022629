//! The models that values of robot kinds come from.

use super::chain::{chain, models, table};
use base::document::{Document, Node, Value, path_of};
use base::error::{InputError, InputErrors, Problem};
use std::collections::BTreeSet;

/// The errors of a document that was completed from its models, each at the path where its value was written.
/// Those of a model that several kinds have are reported once.
pub(crate) fn at_models(InputErrors(errors): InputErrors, document: &Document) -> InputErrors {
    let mut reported = BTreeSet::new();
    let errors = errors
        .into_iter()
        .map(|error| match source(&error, document) {
            Some(path) => InputError { path, ..error },
            None => error,
        });
    let is_new = |error: &InputError| {
        // A model and a kind do not have the same known keys.
        let allowed = match error.problem {
            Problem::UnknownKey(_) => String::new(),
            _ => error.allowed.clone(),
        };
        !error.path.starts_with("models.") || reported.insert((error.path.clone(), allowed))
    };
    InputErrors(errors.filter(is_new).collect())
}

/// The path of an erroneous value in the model that it comes from; `None` if it does not come from one.
fn source(error: &InputError, document: &Document) -> Option<String> {
    let models = models(document)?;
    let (node, path) = ["robots", "models"].iter().find_map(|key| {
        let tables = table(document, key)?.iter();
        let mut found = tables.filter_map(|(name, node)| {
            let path = error.path.strip_prefix(&path_of(key, name))?;
            Some((node, path.strip_prefix('.')?))
        });
        found.next()
    })?;
    // What is missing is missing in the table that would contain it.
    let place = match error.problem {
        Problem::Missing => path.rsplit_once('.')?.0,
        _ => path,
    };
    if leads_to_a_value(node, place) {
        return None;
    }
    let mut based_on = chain(&node.value, models).into_iter();
    let model = based_on.find(|name| leads_to_a_value(&models[*name], place))?;
    Some(format!("{}.{path}", path_of("models", model)))
}

/// Whether there is a value at a path in a table. Lists are never merged, so the path may end at one.
fn leads_to_a_value(node: &Node, path: &str) -> bool {
    let Value::Table(table) = &node.value else {
        return true;
    };
    table.iter().any(|(key, node)| {
        let rest = path.strip_prefix(&path_of("", key));
        rest.is_some_and(|rest| match rest.strip_prefix('.') {
            Some(inner) => leads_to_a_value(node, inner),
            None => rest.is_empty() || rest.starts_with('['),
        })
    })
}
