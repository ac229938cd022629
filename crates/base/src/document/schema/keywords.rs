//! Keywords of schemas.

use serde_json::{Map, Value as Json};

/// The keyword of a string that is one of the listed names, or a key of the table of this name in the
/// document.
pub(super) const NAMES: &str = "x-names";

/// The properties of an object's schema, or the keywords of any.
pub(super) type Object = Map<String, Json>;

/// The subschemas of a list such as `oneOf`; none if it is not there.
pub(super) fn list<'s>(schema: &'s Object, key: &str) -> &'s [Json] {
    schema
        .get(key)
        .and_then(Json::as_array)
        .map_or(&[], |list| list)
}

/// The alternatives of a schema that has some.
pub(super) fn alternatives(schema: &Object) -> &[Json] {
    let either = list(schema, "oneOf");
    if either.is_empty() {
        list(schema, "anyOf")
    } else {
        either
    }
}
