//! What a study varies: paths in a scenario, each with its values.

use super::values::{ALLOWED, Values, values};
use crate::document::{Document, Section, Value};
use crate::engine::Engine;
use crate::error::{InputError, nearest};

/// What is varied, and over what.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// Keys from the scenario's root, with dots between.
    pub path: String,
    /// At least one.
    pub values: Values,
}

/// Why nothing can be varied at a path.
pub(super) struct Refusal {
    allowed: String,
    suggestion: Option<String>,
}

impl Refusal {
    /// The error of `value` at `path`.
    pub(super) fn of(self, path: &str, value: &Value, origin: &str) -> InputError {
        InputError {
            origin: Some(origin.to_owned()),
            suggestion: self.suggestion,
            ..InputError::new(path.to_owned(), Some(value.to_string()), self.allowed)
        }
    }
}

/// Why an engine's studies cannot vary what stands at `path`, if that is plain from the path alone.
pub(super) fn refusal(engine: &dyn Engine, path: &str) -> Option<Refusal> {
    if let Some(listed) = engine.factors() {
        return (!listed.contains(&path)).then(|| Refusal {
            allowed: format!("one of the known keys here: {}", listed.join(", ")),
            suggestion: nearest(path, listed.iter().copied()).map(str::to_owned),
        });
    }
    let keys = engine.keys().iter().copied();
    let first = path.split('.').next().unwrap_or_default();
    (!engine.keys().contains(&first)).then(|| Refusal {
        allowed: format!(
            "a path that begins with one of {}",
            engine.keys().join(", ")
        ),
        suggestion: nearest(first, keys).map(|key| path.replacen(first, key, 1)),
    })
}

/// Puts `value` at the keys of `path`.
pub(super) fn put(document: &mut Document, path: &str, value: &Value, origin: &str) {
    let keys: Vec<&str> = path.split('.').collect();
    document.set(&keys, value.clone(), origin);
}

/// The factors of a study, in the engine's order.
pub(super) fn factors(vary: &Section, engine: &dyn Engine) -> Option<Vec<Factor>> {
    for path in vary.keys() {
        if let Some(Refusal {
            allowed,
            suggestion,
        }) = refusal(engine, path)
        {
            vary.error_for(path, &allowed, suggestion);
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

/// Those of `paths` that can be varied, in the engine's order, else in theirs.
pub(super) fn in_order_of<'p>(
    engine: &dyn Engine,
    paths: impl Iterator<Item = &'p str>,
) -> impl Iterator<Item = &'p str> {
    let mut known: Vec<&str> = paths
        .filter(|path| refusal(engine, path).is_none())
        .collect();
    let place = |path: &&str| engine.factors()?.iter().position(|each| each == path);
    known.sort_by_key(place);
    known.into_iter()
}
