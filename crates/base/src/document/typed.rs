//! Conversion of a document to a Rust type.

use super::node::{Node, Value};
use super::root::Document;
use super::schema::Schema;
use crate::error::{InputError, InputErrors};
use serde::de::DeserializeOwned;
use serde_json::Value as Json;
use serde_path_to_error::Segment;

impl Document {
    /// Deserialises the document, after checking it against the `schema` of `T`.
    ///
    /// # Errors
    /// All errors of the document.
    pub fn typed<T: DeserializeOwned>(&self, schema: &Schema) -> Result<T, InputErrors> {
        self.typed_unless(schema, |_| false)
    }

    /// As [`Document::typed`], but some errors are `ignored`.
    ///
    /// # Errors
    /// All other errors of the document.
    pub fn typed_unless<T: DeserializeOwned>(
        &self,
        schema: &Schema,
        ignored: impl Fn(&InputError) -> bool,
    ) -> Result<T, InputErrors> {
        let mut errors = schema.errors(self);
        errors.retain(|error| !ignored(error));
        if !errors.is_empty() {
            return Err(InputErrors(errors));
        }
        // A document that the schema allows can be read, unless the schema disagrees with its type.
        serde_path_to_error::deserialize(json(&self.root)).map_err(|error| {
            let path = error.path().to_string();
            let node = node_at(&self.root, error.path().iter());
            let allowed = format!("readable: {}", error.inner());
            let origin = Some(node.origin.clone());
            let error = InputError::new(path, Some(node.value.to_string()), allowed);
            InputErrors(vec![InputError { origin, ..error }])
        })
    }
}

/// Non-finite numbers, which no schema allows, become null.
fn json(node: &Node) -> Json {
    match &node.value {
        Value::Bool(value) => Json::from(*value),
        Value::Integer(value) => Json::from(*value),
        Value::Float(value) => Json::from(*value),
        Value::Text(text) | Value::Date(text) => Json::from(text.as_str()),
        Value::List(items) => items.iter().map(json).collect(),
        Value::Table(table) => {
            let entries = table.iter().map(|(key, node)| (key.clone(), json(node)));
            Json::Object(entries.collect())
        }
    }
}

/// The innermost existing value on a path.
fn node_at<'d, 'p>(root: &'d Node, path: impl Iterator<Item = &'p Segment>) -> &'d Node {
    let mut node = root;
    for segment in path {
        let next = match (&node.value, segment) {
            (Value::Table(table), Segment::Map { key }) => table.get(key),
            (Value::List(items), Segment::Seq { index }) => items.get(*index),
            _ => None,
        };
        node = next.unwrap_or(node);
    }
    node
}
