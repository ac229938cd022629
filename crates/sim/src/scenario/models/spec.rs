//! A robot model of a scenario, as it is written.

use crate::bodies::RobotSpec;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A robot model: any keys of a robot kind except `count`. Robot kinds read their values from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ModelSpec(BTreeMap<String, Json>);

impl JsonSchema for ModelSpec {
    fn schema_name() -> Cow<'static, str> {
        "ModelSpec".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = RobotSpec::json_schema(generator);
        schema.remove("required");
        if let Some(Json::Object(properties)) = schema.get_mut("properties") {
            properties.shift_remove("count");
        }
        let about =
            "The keys of a robot kind, except `count`. A model may itself be based on a `model`.";
        schema.insert("description".to_owned(), about.into());
        schema
    }
}
