//! A JSON Schema in a simplified form.

use super::closed::closed;
use super::keywords::{Object, alternatives, list};
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::Value as Json;

/// A JSON Schema of draft 7 in a simplified form: objects allow no other keys than their properties,
/// null is not allowed, and compositions are written out.
#[derive(Debug, Clone, PartialEq)]
pub struct Schema {
    pub(super) root: Json,
}

impl Schema {
    /// The schema of a type.
    #[must_use]
    pub fn of<T: JsonSchema>() -> Self {
        // Its transforms would hide what `closed` looks for.
        let settings = SchemaSettings::draft07().with(|settings| settings.transforms.clear());
        Self::closed(settings.into_generator().into_root_schema_for::<T>())
    }

    /// `schema` in the simplified form.
    #[must_use]
    pub fn closed(schema: schemars::Schema) -> Self {
        Self {
            root: closed(schema),
        }
    }

    /// That of a file of `schemas`, whose parts with a description refer to others by `allOf`, as editors need it.
    #[must_use]
    pub fn for_editors(root: Json) -> Self {
        Self { root }
    }

    /// The same, with any other keys allowed at the root.
    #[must_use]
    pub fn open(mut self) -> Self {
        if let Some(root) = self.root.as_object_mut() {
            root.insert("additionalProperties".to_owned(), Json::Bool(true));
        }
        self
    }

    /// The schema itself.
    #[must_use]
    pub fn json(&self) -> &Json {
        &self.root
    }

    /// Whether the keys of the table at `path` are names that the user chooses.
    #[must_use]
    pub fn has_names_at(&self, path: &[&str]) -> bool {
        self.has_names_below(&self.root, path)
    }

    fn has_names_below(&self, part: &Json, path: &[&str]) -> bool {
        let Some(keywords) = self.keywords(part) else {
            return false;
        };
        let others = keywords.get("additionalProperties");
        let others = others.filter(|others| others.is_object());
        let is_so = match path.split_first() {
            None => others.is_some(),
            Some((key, rest)) => {
                let known = keywords.get("properties").and_then(|known| known.get(key));
                let inner = known.or(others);
                inner.is_some_and(|inner| self.has_names_below(inner, rest))
            }
        };
        let mut forms = alternatives(keywords).iter();
        is_so || forms.any(|form| self.has_names_below(form, path))
    }

    /// The keywords of `schema`, following references; `None` for a schema that allows anything.
    #[must_use]
    pub fn keywords<'s>(&'s self, schema: &'s Json) -> Option<&'s Object> {
        let mut schema = schema.as_object()?;
        // A chain of references has at most as many links as there are definitions; cycles mean nothing.
        for _ in 0..100 {
            let next = match (schema.get("$ref"), list(schema, "allOf")) {
                (Some(target), _) => self.root.pointer(target.as_str()?.strip_prefix('#')?)?,
                (None, [only]) => only,
                _ => return Some(schema),
            };
            schema = next.as_object()?;
        }
        None
    }
}
