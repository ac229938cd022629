//! Paths through a name that the scenario does not have: most often a slip, sometimes a new thing.

use crate::document::{Document, Node, Value, path_of};
use crate::engine::{Configuration, Engine};
use crate::error::{InputError, InputErrors, nearest, shortened};

/// A name on a path, in a table of things under names, that the scenario does not have.
pub(super) struct Unknown<'p> {
    path: &'p [&'p str],
    /// Which key of the path it is.
    place: usize,
    /// The names that there are.
    names: Vec<String>,
}

impl<'p> Unknown<'p> {
    /// The first on a path, but not its end: what stands there says what it is.
    pub(super) fn on(
        path: &'p [&'p str],
        engine: &dyn Engine,
        document: &Document,
    ) -> Option<Self> {
        (1..path.len().saturating_sub(1)).find_map(|place| {
            let names = engine.names(document, &path[..place])?;
            let is_there = names.iter().any(|name| name == path[place]);
            (!is_there).then_some(Self { path, place, names })
        })
    }

    /// The one at a place of a path for which a table was made.
    fn made(
        path: &'p [&'p str],
        place: usize,
        engine: &dyn Engine,
        document: &Document,
    ) -> Option<Self> {
        let mut names = engine.names(document, &path[..place])?;
        names.retain(|name| name != path[place]);
        Some(Self { path, place, names })
    }

    /// `errors`, with one of the `node` at the path in place of those of what is missing.
    fn told_in(&self, errors: Vec<InputError>, node: &Node) -> Vec<InputError> {
        let thing = format!("{}.", joined(&self.path[..=self.place]));
        let is_missing =
            |error: &InputError| error.given.is_none() && error.path.starts_with(&thing);
        let (missing, mut told): (Vec<_>, Vec<_>) = errors.into_iter().partition(is_missing);
        let missing: Vec<&str> = missing
            .iter()
            .map(|error| &error.path[thing.len()..])
            .collect();
        if !missing.is_empty() {
            told.push(self.error(&node.value, &node.origin, &missing));
        }
        told
    }

    /// The error of `value` at the path; a new thing under this name would need all of `missing`.
    pub(super) fn error(&self, value: &Value, origin: &str, missing: &[&str]) -> InputError {
        let near = nearest(self.path[self.place], self.names.iter().map(String::as_str));
        InputError {
            origin: Some(origin.to_owned()),
            suggestion: near.map(|name| self.path_with(name)),
            ..InputError::new(
                joined(self.path),
                Some(value.to_string()),
                self.allowed(missing),
            )
        }
    }

    fn allowed(&self, missing: &[&str]) -> String {
        let names = match &self.names[..] {
            [] => ", of which there is none".to_owned(),
            names => format!(": {}", names.join(", ")),
        };
        let table = joined(&self.path[..self.place]);
        let one_more = match missing {
            [] => String::new(),
            [one] => format!("; a new one needs {one} too"),
            [first @ .., last] => format!("; a new one needs {} and {last} too", first.join(", ")),
        };
        format!(
            "under one of the names in {}{names}{one_more}",
            shortened(&table)
        )
    }

    fn path_with(&self, name: &str) -> String {
        let mut path = self.path.to_vec();
        path[self.place] = name;
        joined(&path)
    }
}

/// What an engine reads of a document; what a thing lacks that is there only because an option has
/// a value for it is told in one, with the names that there are besides.
///
/// # Errors
/// Everything that is wrong there.
pub(super) fn read(engine: &dyn Engine, document: &Document) -> Result<Configuration, InputErrors> {
    engine.read(document).map_err(|InputErrors(mut errors)| {
        for made in document.made() {
            let path: Vec<&str> = made.path.iter().map(String::as_str).collect();
            let unknown = Unknown::made(&path, made.place, engine, document);
            if let Some((unknown, node)) = unknown.zip(document.get(&path)) {
                errors = unknown.told_in(errors, node);
            }
        }
        InputErrors(errors)
    })
}

fn joined(path: &[&str]) -> String {
    path.iter()
        .fold(String::new(), |path, key| path_of(&path, key))
}
