//! A place in a document, to report errors there.

use super::node::{Node, Value, path_of};
use super::root::Document;
use crate::error::InputError;
use crate::warning::Warning;

/// A place in a document, whether or not there is a value.
///
/// ```
/// use base::document::Document;
/// let document = Document::parse("job.toml", "\n[[walls]]\ncorners = [1, 2]").unwrap();
/// let walls = document.place().key("walls");
/// assert_eq!(
///     walls.item(0).key("corners").error("a triangle").to_string(),
///     "job.toml:3: walls[0].corners = [1, 2]: must be a triangle"
/// );
/// assert_eq!(
///     walls.item(0).key("height").error("a number above 0").to_string(),
///     "job.toml:2: walls[0].height is missing: expected a number above 0"
/// );
/// ```
#[derive(Debug, Clone)]
pub struct Place<'d> {
    /// The value there, if any.
    node: Option<&'d Node>,
    /// Origin of the value; without one, that of the table or list that should contain it.
    origin: &'d str,
    path: String,
}

impl Document {
    /// The root of the document.
    #[must_use]
    pub fn place(&self) -> Place<'_> {
        Place {
            node: Some(&self.root),
            origin: &self.root.origin,
            path: String::new(),
        }
    }
}

impl<'d> Place<'d> {
    /// The place of `key` in the table here.
    #[must_use]
    pub fn key(&self, key: &str) -> Self {
        let node = match self.node.map(|node| &node.value) {
            Some(Value::Table(table)) => table.get(key),
            _ => None,
        };
        self.inner(node, path_of(&self.path, key))
    }

    /// The place of the `index`-th item, from 0, of the list here.
    #[must_use]
    pub fn item(&self, index: usize) -> Self {
        let node = match self.node.map(|node| &node.value) {
            Some(Value::List(items)) => items.get(index),
            _ => None,
        };
        self.inner(node, format!("{}[{index}]", self.path))
    }

    fn inner(&self, node: Option<&'d Node>, path: String) -> Self {
        let origin = node.map_or(self.origin, |node| &node.origin);
        Self { node, origin, path }
    }

    /// The value here, as an error shows it.
    #[must_use]
    pub fn value(&self) -> Option<String> {
        self.node.map(|node| node.value.to_string())
    }

    /// The error that the value here is not what is `allowed`, or missing.
    #[must_use]
    pub fn error(&self, allowed: impl Into<String>) -> InputError {
        InputError {
            origin: Some(self.origin.to_owned()),
            ..InputError::new(self.path.clone(), self.value(), allowed.into())
        }
    }

    /// A warning about the value here.
    #[must_use]
    pub fn warning(&self, effect: String) -> Warning {
        Warning {
            origin: self.origin.to_owned(),
            path: self.path.clone(),
            value: self.value(),
            effect,
        }
    }

    /// The error that the key of this place, `key`, is none of the `known` keys.
    pub fn unknown_key<'n>(
        &self,
        key: &str,
        known: impl Iterator<Item = &'n str> + Clone,
    ) -> InputError {
        InputError {
            origin: Some(self.origin.to_owned()),
            ..InputError::unknown_key(
                self.path.clone(),
                key,
                self.value().unwrap_or_default(),
                known,
            )
        }
    }
}
