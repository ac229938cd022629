//! Checks a document against a JSON Schema and reports all errors at once, each with its line.
//!
//! The schema is derived from the Rust types that serde reads the document into, so that the checks, the
//! completion in editors and the reader cannot disagree.
//!
//! ```
//! use base::document::{Document, schema::Schema};
//! use schemars::JsonSchema;
//! use serde::Deserialize;
//!
//! #[derive(Debug, PartialEq, Deserialize, JsonSchema)]
//! struct Job {
//!     /// When it ends, in seconds.
//!     #[schemars(range(min = 0.0, max = 1e6))]
//!     time_limit_s: f64,
//!     count: u8,
//! }
//! let schema = Schema::of::<Job>();
//! let job = Document::parse("job.toml", "time_limit_s = 120\ncount = 3")?.typed(&schema);
//! assert_eq!(job, Ok(Job { time_limit_s: 120.0, count: 3 }));
//! let job = Document::parse("job.toml", "time_limit_s = -1\ncuont = 3")?.typed::<Job>(&schema);
//! assert_eq!(
//!     job.unwrap_err().to_string(),
//!     "job.toml:2: cuont is not a known key: expected one of time_limit_s, count; \
//!      did you mean count?\n\
//!      job.toml:1: time_limit_s = -1: must be a number from 0 to 1000000 (seconds)\n\
//!      job.toml: count is missing: expected a whole number from 0 to 255"
//! );
//! # Ok::<(), base::error::InputErrors>(())
//! ```

mod check;
mod closed;
mod expected;
mod forms;
pub mod units;

use super::Document;
use crate::error::InputError;
use check::Check;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value as Json};

/// The properties of an object's schema, or the keywords of any.
type Object = Map<String, Json>;

/// A JSON Schema of draft 7 in a simplified form: objects allow no other keys than their properties,
/// null is not allowed, and compositions are written out.
#[derive(Debug, Clone, PartialEq)]
pub struct Schema {
    root: Json,
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
            root: closed::closed(schema),
        }
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

    /// All errors of `document`.
    #[must_use]
    pub fn errors(&self, document: &Document) -> Vec<InputError> {
        let mut check = Check::new(self);
        check.value(&self.root, &document.root, "");
        check.errors
    }

    /// What `part` of the schema allows, as a noun phrase: "a number from 0 to 100 (metres)".
    #[must_use]
    pub fn expected(&self, part: &Json) -> String {
        expected::expected(self, part)
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
            let Some(Json::String(target)) = schema.get("$ref") else {
                return Some(schema);
            };
            let target = target.strip_prefix('#')?;
            schema = self.root.pointer(target)?.as_object()?;
        }
        None
    }
}

/// The subschemas of a list such as `oneOf`; none if it is not there.
fn list<'s>(schema: &'s Object, key: &str) -> &'s [Json] {
    schema
        .get(key)
        .and_then(Json::as_array)
        .map_or(&[], |list| list)
}

/// The alternatives of a schema that has some.
fn alternatives(schema: &Object) -> &[Json] {
    let either = list(schema, "oneOf");
    if either.is_empty() {
        list(schema, "anyOf")
    } else {
        either
    }
}

#[cfg(test)]
mod tests;
