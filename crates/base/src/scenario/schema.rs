//! The JSON Schema of the question's keys, for editors and the reference page.
//!
//! Their errors are told by the sections that read them, which know what else there is: what can be
//! varied, and what a figure of merit can weigh.

use super::merit::{MAX_MAX, MAX_WEIGHT};
use super::study::CONFIDENCE;
use crate::document::Document;
use crate::engine::{Engine, MAX_CAP_S, Measure};
use serde_json::{Map, Value as Json, json};

/// What a scenario of `engine` may say under the question's keys; what can be weighed may depend on
/// the `document`.
#[must_use]
pub fn schema(engine: &dyn Engine, document: &Document) -> Json {
    json!({
        "type": "object",
        "properties": {
            "engine": {
                "description": "The simulator.",
                "const": engine.name(),
            },
            "summary": {
                "description": "One line for people: what is done, by whom, for how long.",
                "type": "string",
                "minLength": 1,
            },
            "merit": merit(engine, document),
            "study": study(),
            "published": published(),
        },
        "required": ["engine", "summary", "merit"],
        "additionalProperties": false,
        "definitions": { "Term": term() },
    })
}

fn merit(engine: &dyn Engine, document: &Document) -> Json {
    let names: Vec<&str> = engine.merits().iter().map(|merit| merit.name).collect();
    let to_term = json!({ "$ref": "#/definitions/Term" });
    let term = |measure: Measure| (measure.name.into_owned(), to_term.clone());
    let terms: Map<String, Json> = engine.measures(document).into_iter().map(term).collect();
    json!({
        "description": "What a run is scored by; higher is better. A name, or weights of your own: \
                        what a second, a robot and so on is worth, such as \
                        `{ time = -0.03, robots = -0.2, failed = -5 }`.",
        "anyOf": [
            { "type": "string", "enum": names },
            { "type": "object", "properties": terms, "additionalProperties": false },
        ],
    })
}

fn term() -> Json {
    let weight = json!({
        "description": "The weight; below 0 for what is better small.",
        "type": "number",
        "minimum": -MAX_WEIGHT,
        "maximum": MAX_WEIGHT,
    });
    let capped = json!({
        "type": "object",
        "properties": {
            "weight": weight,
            "max": {
                "description": "A value above this counts as this; a term without a bound of its \
                                own needs it.",
                "type": "number",
                "minimum": 0,
                "maximum": MAX_MAX,
            },
        },
        "required": ["weight"],
        "additionalProperties": false,
    });
    json!({
        "description": "What a value of a run weighs.",
        "anyOf": [weight, capped],
    })
}

fn study() -> Json {
    json!({
        "description": "What a study does.",
        "type": "object",
        "properties": {
            "vary": {
                "description": "What is varied: the path of a value in this file, such as \
                                `\"robots.rover.count\"`, and a text of its values.",
                "type": "object",
                "additionalProperties": {
                    "description": "`1..40` for whole numbers, both ends included; `1,2,4` or \
                                    `0.5,1.0` or `ground,air` for these; `0.5..1.5` for any number \
                                    of the range, for the designs `lhs:` and `sobol:` only.",
                    "type": "string",
                    "minLength": 1,
                },
                "default": {},
            },
            "design": {
                "description": "Which configurations are compared: `factorial` for each value with \
                                each of every other; `lhs:200` or `sobol:256` for so many points \
                                that fill the space, for `sobol` a power of two.",
                "type": "string",
                "pattern": "^(factorial|lhs:[0-9]+|sobol:[0-9]+)$",
                "default": "factorial",
            },
            "delta": {
                "description": "A difference of merit that is worth finding; left out, 2% of the \
                                range of merits.",
                "type": "number",
                "exclusiveMinimum": 0,
            },
            "confidence": {
                "description": "How often the answer is to be right.",
                "type": "number",
                "exclusiveMinimum": 0.5,
                "exclusiveMaximum": 1,
                "default": CONFIDENCE,
            },
        },
        "additionalProperties": false,
    })
}

fn published() -> Json {
    json!({
        "description": "Results of others, to show beside those of a study.",
        "type": "object",
        "properties": {
            "source": {
                "description": "Where they stand.",
                "type": "string",
                "minLength": 1,
            },
            "choice": {
                "description": "The team size that they recommend.",
                "type": "integer",
                "minimum": 1,
            },
            "time_limit_s": {
                "description": "Where they stopped, in seconds; a time of this much is a failed run.",
                "type": "number",
                "minimum": 0,
                "maximum": MAX_CAP_S,
            },
            "times_s": {
                "description": "Under each team size the times of its runs, in seconds.",
                "type": "object",
                "additionalProperties": {
                    "type": "array",
                    "items": { "type": "number", "minimum": 0, "maximum": MAX_CAP_S },
                    "minItems": 2,
                },
            },
        },
        "required": ["source", "choice", "time_limit_s", "times_s"],
        "additionalProperties": false,
    })
}
