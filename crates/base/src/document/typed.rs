//! A whole document as a Rust type.

use super::schema::Schema;
use super::{Document, Node, Value};
use crate::error::{InputError, InputErrors};
use serde::de::DeserializeOwned;
use serde_json::Value as Json;
use serde_path_to_error::Segment;

impl Document {
    /// What serde makes of the document, if it is as the `schema` of `T` says.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn typed<T: DeserializeOwned>(&self, schema: &Schema) -> Result<T, InputErrors> {
        let errors = schema.errors(self);
        if !errors.is_empty() {
            return Err(InputErrors(errors));
        }
        // What the schema of a type allows is read; should one disagree with its type, it is told.
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

/// Numbers that are not finite become null: a schema allows none.
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

/// The innermost value on a path that is there.
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
