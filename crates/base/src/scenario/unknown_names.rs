//! Paths through a name that the scenario does not have: usually a typing error, sometimes a new
//! entry.

use crate::document::{Document, Node, Value, path_of};
use crate::engine::{Configuration, Engine};
use crate::error::{InputError, InputErrors, Problem, nearest, shortened};

/// A name on a path, in a table whose keys are names, that the scenario does not have.
pub(super) struct Unknown<'p> {
    path: &'p [&'p str],
    /// Index of the name among the keys of the path.
    place: usize,
    /// The existing names.
    names: Vec<String>,
}

impl<'p> Unknown<'p> {
    /// The first unknown name on a path, except for its last key, which defines the entry.
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

    /// The name for which an option created a table.
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

    /// `errors`, with those about missing keys of the new entry replaced by one of the `node` at the
    /// path.
    fn summarised(&self, errors: Vec<InputError>, node: &Node) -> Vec<InputError> {
        let thing = format!("{}.", joined(&self.path[..=self.place]));
        let is_missing = |error: &InputError| {
            error.problem == Problem::Missing && error.path.starts_with(&thing)
        };
        let (missing, mut others): (Vec<_>, Vec<_>) = errors.into_iter().partition(is_missing);
        let missing: Vec<&str> = missing
            .iter()
            .map(|error| &error.path[thing.len()..])
            .collect();
        if !missing.is_empty() {
            others.push(self.error(&node.value, &node.origin, &missing));
        }
        others
    }

    /// The error of `value` at the path; a new entry of this name would need all `missing` keys.
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
            [] => ", which is empty".to_owned(),
            names => format!(": {}", names.join(", ")),
        };
        let table = joined(&self.path[..self.place]);
        let one_more = match missing {
            [] => String::new(),
            [one] => format!("; a new entry also needs {one}"),
            [first @ .., last] => {
                format!("; a new entry also needs {} and {last}", first.join(", "))
            }
        };
        format!(
            "in an existing entry of {}{names}{one_more}",
            shortened(&table)
        )
    }

    fn path_with(&self, name: &str) -> String {
        let mut path = self.path.to_vec();
        path[self.place] = name;
        joined(&path)
    }
}

/// Reads the configuration of a document. If an option sets a value of an entry that does not exist,
/// its missing keys are reported as one error, with the existing names.
///
/// # Errors
/// Everything that is wrong there.
pub(super) fn read(engine: &dyn Engine, document: &Document) -> Result<Configuration, InputErrors> {
    engine.read(document).map_err(|InputErrors(mut errors)| {
        for made in document.created_tables() {
            let path: Vec<&str> = made.path.iter().map(String::as_str).collect();
            let unknown = Unknown::made(&path, made.place, engine, document);
            if let Some((unknown, node)) = unknown.zip(document.get(&path)) {
                errors = unknown.summarised(errors, node);
            }
        }
        InputErrors(errors)
    })
}

fn joined(path: &[&str]) -> String {
    path.iter()
        .fold(String::new(), |path, key| path_of(&path, key))
}
