//! The JSON Schema of a whole scenario file of the classic engine, for editors and pages.

use super::{Classic, MAX_ROBOTS};
use crate::clock::PAINTS_PER_S;
use crate::contact::Contact;
use base::document::Document;
use base::document::schema::units::annotate;
use base::engine::MAX_TIME_LIMIT_S;
use base::scenario as common;
use serde_json::{Value as Json, json};

/// The schema of a scenario. JSON Schema of draft 7.
#[must_use]
pub fn schema() -> Json {
    let mut schema = common::schema(&Classic, &Document::default());
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("A scenario of the classic engine");
    schema["description"] = json!("docs/classic.md explains the engine.");
    schema["properties"]["contact"] = contact();
    schema["properties"]["clock"] = clock();
    schema["properties"]["robots"] = table("Robots by kind.", &json!({ "wanderer": wanderer() }));
    schema["required"] = json!(["engine", "summary", "merit", "contact", "clock", "robots"]);
    annotate(&mut schema);
    schema
}

fn contact() -> Json {
    let names = Contact::NAMES.map(|(name, _)| name);
    json!({
        "description": "What counts as finding an item: its distance in cells, that it is straight \
                        ahead, or that the drawn robot touches it.",
        "type": "string",
        "enum": names,
    })
}

fn clock() -> Json {
    let number = |description: &str, (min, max): (f64, f64)| json!({ "description": description, "type": "number", "minimum": min, "maximum": max });
    let paints = "Repaints of the original's window per second.";
    let limit = "A run that takes longer has failed, and counts as this long.";
    let bounds = json!({
        "paints_per_s": number(paints, PAINTS_PER_S.into_inner()),
        "time_limit_s": number(limit, (0.0, MAX_TIME_LIMIT_S)),
    });
    table(
        "Conversion of paints to seconds, and the time limit.",
        &bounds,
    )
}

fn wanderer() -> Json {
    let count = json!({
        "description": "Number of robots in a single run.",
        "type": "integer",
        "minimum": 1,
        "maximum": MAX_ROBOTS,
    });
    table(
        "The robots of the 2003 experiment.",
        &json!({ "count": count }),
    )
}

/// A table with exactly these keys.
fn table(description: &str, properties: &Json) -> Json {
    let keys: Vec<&String> = properties
        .as_object()
        .into_iter()
        .flat_map(|each| each.keys())
        .collect();
    json!({
        "description": description,
        "type": "object",
        "required": keys,
        "properties": properties,
        "additionalProperties": false,
    })
}
