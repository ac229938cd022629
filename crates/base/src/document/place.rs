//! A place in a document, to tell what is wrong there.

use super::{Document, Node, Value, path_of};
use crate::error::{InputError, nearest};

/// A place in a document, whether something stands there or not.
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
///     walls.item(0).key("height").error("above 0").to_string(),
///     "job.toml:2: walls[0].height is missing: must be above 0"
/// );
/// ```
#[derive(Debug, Clone)]
pub struct Place<'d> {
    /// What stands there, if something does.
    node: Option<&'d Node>,
    /// Of what stands there, or else of what it should stand in.
    origin: &'d str,
    path: String,
}

impl Document {
    /// The root, from which other places are found.
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

    /// What is written here, as an error shows it.
    #[must_use]
    pub fn given(&self) -> Option<String> {
        self.node.map(|node| node.value.to_string())
    }

    /// What stands here is not what is `allowed` ("must be ...").
    #[must_use]
    pub fn error(&self, allowed: impl Into<String>) -> InputError {
        InputError {
            origin: Some(self.origin.to_owned()),
            ..InputError::new(self.path.clone(), self.given(), allowed.into())
        }
    }

    /// The key that leads here, `word`, names none of the `names` that there are.
    #[must_use]
    pub fn names_none_of<'n>(
        &self,
        word: &str,
        names: impl Iterator<Item = &'n str> + Clone,
    ) -> InputError {
        let known: Vec<&str> = names.clone().collect();
        InputError {
            suggestion: nearest(word, names).map(str::to_owned),
            ..self.error(format!("under one of {}", known.join(", ")))
        }
    }
}
