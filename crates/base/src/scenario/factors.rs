//! What a study varies: paths in a scenario, each with its values.

use super::values::{ALLOWED, Values, as_f64, largest_of, values};
use crate::document::{Document, Section, Value, renamed};
use crate::engine::Engine;
use crate::error::{InputError, nearest};

/// A factor of a study: a path with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// Keys from the root of the scenario, separated by dots.
    pub path: String,
    /// At least one value.
    pub values: Values,
}

/// The error, at `at`, of a `path` that the engine's studies cannot vary, if the path alone shows it.
pub(super) fn refusal(
    engine: &dyn Engine,
    path: &str,
    at: String,
    value: &Value,
) -> Option<InputError> {
    let value = value.to_string();
    if let Some(listed) = engine.factors() {
        let listed = listed.iter().copied();
        return match renamed::path(path, listed.clone()) {
            Some(new) => Some(InputError::renamed(at, None, new.to_owned())),
            None if listed.clone().any(|known| known == path) => None,
            None => Some(InputError::unknown_key(at, path, value, listed)),
        };
    }
    let keys = engine.keys();
    let first = path.split('.').next().unwrap_or_default();
    (!keys.contains(&first)).then(|| InputError {
        suggestion: nearest(first, keys.iter().copied()).map(|key| path.replacen(first, key, 1)),
        ..InputError::new(
            at,
            Some(value),
            format!("a path that begins with one of {}", keys.join(", ")),
        )
    })
}

fn can_be_varied(engine: &dyn Engine, path: &str) -> bool {
    refusal(engine, path, String::new(), &Value::Bool(true)).is_none()
}

/// Puts `value` at the keys of `path`.
pub(super) fn put(document: &mut Document, path: &str, value: &Value, origin: &str) {
    let keys: Vec<&str> = path.split('.').collect();
    document.vary(&keys, value.clone(), origin);
}

/// The largest number at a path in any configuration of a document: its own, those that `study.vary` lists, and one
/// that was put there.
#[must_use]
pub fn largest(document: &Document, path: &[&str]) -> Option<f64> {
    let varied = ["study", "vary", &path.join(".")];
    let listed = match document.get(&varied).map(|node| &node.value) {
        Some(Value::Text(text)) => largest_of(text),
        _ => None,
    };
    let current = document.get(path).map(|node| &node.value);
    let numbers = [document.own(path), current].into_iter().flatten();
    numbers.filter_map(as_f64).chain(listed).reduce(f64::max)
}

/// The factors of a study, in the engine's order.
pub(super) fn factors(vary: &Section, engine: &dyn Engine) -> Option<Vec<Factor>> {
    for path in vary.keys() {
        let value = vary.value(path).unwrap_or(&Value::Bool(false));
        if let Some(error) = refusal(engine, path, vary.path_of(path), value) {
            vary.report(path, error);
        }
    }
    let factor = |path: &str| {
        let read = match vary.value(path) {
            Some(Value::Text(text)) => values(text),
            _ => Err(ALLOWED.to_owned()),
        };
        let values = read.map_err(|allowed| vary.error(path, &allowed)).ok()?;
        let path = path.to_owned();
        Some(Factor { path, values })
    };
    let factors: Vec<Option<Factor>> = in_order_of(engine, vary.keys()).map(factor).collect();
    factors.into_iter().collect()
}

/// Those of `paths` that can be varied: in the engine's order if it has one, otherwise in theirs.
pub(super) fn in_order_of<'p>(
    engine: &dyn Engine,
    paths: impl Iterator<Item = &'p str>,
) -> impl Iterator<Item = &'p str> {
    let mut known: Vec<&str> = paths.filter(|path| can_be_varied(engine, path)).collect();
    let place = |path: &&str| engine.factors()?.iter().position(|each| each == path);
    known.sort_by_key(place);
    known.into_iter()
}
