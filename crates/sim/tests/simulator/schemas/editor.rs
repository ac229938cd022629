//! The JSON Schema of a scenario file, for editors.

use schemars::transform::{RemoveRefSiblings, Transform};
use serde_json::{Map, Value as Json, json};
use sim::scenario::ScenarioSpec;
use std::collections::BTreeSet;

/// The schema of the reader, with the keys that all engines share; a robot with a `model` does not need the
/// keys that the model sets.
pub(crate) fn schema() -> Json {
    let mut schema = ScenarioSpec::schema().json().clone();
    let common = super::common();
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
    // Editors for older drafts ignore keys beside a `$ref`.
    let mut schema = schemars::Schema::try_from(schema).unwrap();
    RemoveRefSiblings::default().transform(&mut schema);
    schema.to_value()
}

fn joined(one: &Json, other: &Json) -> Json {
    let both = [one, other].map(|each| each.as_object().cloned().unwrap());
    Json::Object(both.into_iter().flatten().collect::<Map<_, _>>())
}

/// The definitions that are used by robots and their models only, except for controllers, which have the same radios.
fn of_robots_only(schema: &Json) -> BTreeSet<String> {
    let mut rest = schema["properties"].clone();
    rest["controllers"].take();
    let [mut robots, mut others] = [BTreeSet::new(), BTreeSet::new()];
    for key in ["robots", "models"] {
        rest[key].take();
        refer(schema, &schema["properties"][key], &mut robots);
    }
    refer(schema, &rest, &mut others);
    &robots - &others
}

/// Collects the names of the definitions to which `part` refers, directly or indirectly.
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

/// `part` without required keys and defaults, since the model provides the values.
fn optional(part: &Json) -> Json {
    match part {
        Json::Object(keywords) => {
            let kept = keywords
                .iter()
                .filter(|(key, _)| !["required", "default"].contains(&key.as_str()));
            let each = kept.map(|(key, value)| {
                // Without the key that distinguishes them, several variants may match.
                let key = if key == "oneOf" { "anyOf" } else { key };
                (key.to_owned(), optional(value))
            });
            Json::Object(each.collect())
        }
        Json::Array(parts) => parts.iter().map(optional).collect(),
        plain => plain.clone(),
    }
}
