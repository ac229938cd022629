//! The JSON Schema of a whole scenario file, for editors.

use schemars::transform::{RemoveRefSiblings, Transform};
use serde_json::{Map, Value as Json, json};
use sim::scenario::ScenarioSpec;
use std::collections::BTreeSet;

/// The schema: that of the reader, with the keys that all engines share; a robot that is `like` a shipped one
/// need say nothing that the model says.
pub(crate) fn schema() -> Json {
    let mut schema = ScenarioSpec::schema().json().clone();
    let common = crate::common();
    schema["properties"] = joined(&common["properties"], &schema["properties"]);
    schema["definitions"] = joined(&common["definitions"], &schema["definitions"]);
    let required = [&common["required"], &schema["required"]];
    schema["required"] = required
        .into_iter()
        .filter_map(Json::as_array)
        .flatten()
        .cloned()
        .collect();
    schema["additionalProperties"] = json!(false);
    schema["title"] = json!("A scenario of the metric engine");
    schema["description"] = json!("docs/scenario.md explains every key.");
    let needed = schema["definitions"]["RobotSpec"]["required"].clone();
    for name in of_robots_only(&schema) {
        schema["definitions"][&name] = optional(&schema["definitions"][&name]);
    }
    let robot = &mut schema["definitions"]["RobotSpec"];
    robot["required"] = json!(["count"]);
    robot["anyOf"] = json!([{ "required": ["model"] }, { "required": needed }]);
    // Editors of older drafts look at nothing beside a $ref.
    let mut schema = schemars::Schema::try_from(schema).unwrap();
    RemoveRefSiblings::default().transform(&mut schema);
    schema.to_value()
}

fn joined(one: &Json, other: &Json) -> Json {
    let both = [one, other].map(|each| each.as_object().cloned().unwrap());
    Json::Object(both.into_iter().flatten().collect::<Map<_, _>>())
}

/// The definitions that describe robots and nothing else.
fn of_robots_only(schema: &Json) -> BTreeSet<String> {
    let mut rest = schema["properties"].clone();
    rest["robots"].take();
    let [mut robots, mut others] = [BTreeSet::new(), BTreeSet::new()];
    refer(schema, &schema["properties"]["robots"], &mut robots);
    refer(schema, &rest, &mut others);
    &robots - &others
}

/// Gathers the names of the definitions to which `part` refers, at once or by way of others.
fn refer(schema: &Json, part: &Json, names: &mut BTreeSet<String>) {
    match part {
        Json::Object(keywords) => {
            let target = keywords.get("$ref").and_then(Json::as_str);
            let name = target.and_then(|target| target.strip_prefix("#/definitions/"));
            if let Some(name) = name.filter(|name| names.insert((*name).to_owned())) {
                refer(schema, &schema["definitions"][name], names);
            }
            keywords
                .values()
                .for_each(|part| refer(schema, part, names));
        }
        Json::Array(parts) => parts.iter().for_each(|part| refer(schema, part, names)),
        _ => {}
    }
}

/// `part` in which no key need be there, and none has a default, which would be the model's.
fn optional(part: &Json) -> Json {
    match part {
        Json::Object(keywords) => {
            let kept = keywords
                .iter()
                .filter(|(key, _)| !["required", "default"].contains(&key.as_str()));
            let each = kept.map(|(key, value)| {
                // Without the key that tells them apart, several forms may fit.
                let key = if key == "oneOf" { "anyOf" } else { key };
                (key.to_owned(), optional(value))
            });
            Json::Object(each.collect())
        }
        Json::Array(parts) => parts.iter().map(optional).collect(),
        plain => plain.clone(),
    }
}
