//! The JSON Schema of the common keys, for editors and the reference page.
//!
//! Errors are reported by the functions that read the keys, which also know what can be varied and
//! what a figure of merit can weigh.

use super::merit::{MAX_MAX, MAX_WEIGHT};
use super::require::{MAX_CONDITIONS, PROBABILITY};
use super::study::{CONFIDENCE, MINIMIZE};
use crate::document::Document;
use crate::document::schema::units::annotate;
use crate::engine::{Engine, MAX_TIME_LIMIT_S, MeritTerm};
use serde_json::{Map, Value as Json, json};

/// The common keys of a scenario of `engine`. The terms of a figure of merit may depend on the
/// `document`.
#[must_use]
pub fn schema(engine: &dyn Engine, document: &Document) -> Json {
    let mut schema = json!({
        "type": "object",
        "properties": {
            "engine": {
                "description": "The simulator.",
                "const": engine.name(),
            },
            "summary": {
                "description": "One line of description: the task, the robots and the time limit.",
                "type": "string",
                "minLength": 1,
            },
            "merit": merit(engine, document),
            "require": require(),
            "study": study(),
            "published": published(),
        },
        "required": ["engine", "summary", "merit"],
        "additionalProperties": false,
        "definitions": { "Term": term() },
    });
    annotate(&mut schema);
    schema
}

fn merit(engine: &dyn Engine, document: &Document) -> Json {
    let names: Vec<&str> = engine.merits().iter().map(|merit| merit.name).collect();
    let to_term = json!({ "$ref": "#/definitions/Term" });
    let term = |merit_term: MeritTerm| (merit_term.name.into_owned(), to_term.clone());
    let terms: Map<String, Json> = engine.merit_terms(document).into_iter().map(term).collect();
    json!({
        "description": "Figure of merit of a run; higher is better. A predefined name, or a table of \
                        weights on its outcome, such as \
                        `{ time = -0.03, robots = -0.2, failed = -5 }`.",
        "anyOf": [
            { "type": "string", "enum": names },
            { "type": "object", "properties": terms, "additionalProperties": false },
        ],
    })
}

fn term() -> Json {
    let weight = json!({
        "description": "Weight of the term; negative if smaller values are better.",
        "type": "number",
        "minimum": -MAX_WEIGHT,
        "maximum": MAX_WEIGHT,
    });
    let capped = json!({
        "type": "object",
        "properties": {
            "weight": weight,
            "max": {
                "description": "Cap: a larger value counts as this. Required for a term without a \
                                natural bound.",
                "type": "number",
                "minimum": 0,
                "maximum": MAX_MAX,
            },
        },
        "required": ["weight"],
        "additionalProperties": false,
    });
    json!({
        "description": "Weight of this outcome in the sum.",
        "anyOf": [weight, capped],
    })
}

fn study() -> Json {
    json!({
        "description": "Settings of a study.",
        "type": "object",
        "properties": {
            "vary": {
                "description": "Factors to vary: the path of a key in this file, such as \
                                `\"robots.rover.count\"`, and a string of its values.",
                "type": "object",
                "additionalProperties": {
                    "description": "`1..40` for whole numbers, both ends included; `1..41 by 5` with a \
                                    step, `1..1000 log 7` for seven with the same ratio; `1,2,4`, \
                                    `0.5,1.0` or `ground,air` for a list; `0.5..1.5` for any number \
                                    in the range, with the designs `lhs:` and `sobol:` only.",
                    "type": "string",
                    "minLength": 1,
                },
                "default": {},
            },
            "design": {
                "description": "Configurations to compare: `factorial` for all combinations of \
                                values; `lhs:200` or `sobol:256` for a space-filling design with \
                                that number of points (a power of two for `sobol`).",
                "type": "string",
                "pattern": "^(factorial|lhs:[0-9]+|sobol:[0-9]+)$",
                "default": "factorial",
            },
            "delta": {
                "description": "Indifference zone: the smallest difference in merit that matters. \
                                Without it, 2% of the range of merits.",
                "type": "number",
                "exclusiveMinimum": 0,
            },
            "confidence": {
                "description": "Probability that the answer is right.",
                "type": "number",
                "exclusiveMinimum": 0.5,
                "exclusiveMaximum": 1,
                "default": CONFIDENCE,
            },
            "minimize": {
                "description": "With `[require]`, what the selected configuration has least of: \
                                `robots`, `price`, or an expression of the numbers of robots and \
                                controllers of each kind, such as `rover_a + 2 * rover_b`.",
                "type": "string",
                "minLength": 1,
                "default": MINIMIZE,
            },
            "where": {
                "description": "Which configurations to compare, as a condition on the numbers of robots \
                                and controllers of each kind, `robots` and `price`, such as `rover_a == 0 or rover_b == 0`. Without it, all.",
                "type": "string",
                "minLength": 1,
            },
        },
        "additionalProperties": false,
    })
}

fn require() -> Json {
    json!({
        "description": "What a mission must meet. With it, a study selects the configuration with the \
                        least `study.minimize` that meets it.",
        "type": "object",
        "properties": {
            "all": {
                "description": "Conditions on the outcome of a mission, which must all hold, such as \
                                `time_s <= 1200` or `collisions <= 0`. `time_s` is the time of success: \
                                in a mission without success, it is infinite.",
                "type": "array",
                "items": { "type": "string", "minLength": 1 },
                "minItems": 1,
                "maxItems": MAX_CONDITIONS,
            },
            "probability": {
                "description": "The share of missions in which all conditions must hold.",
                "type": "number",
                "exclusiveMinimum": 0,
                "exclusiveMaximum": 1,
                "default": PROBABILITY,
            },
            "tolerance": {
                "description": "A configuration is refuted when its share is shown to be below \
                                `probability` + `tolerance`. Smaller values need more runs. Without it, \
                                40% of 1 - `probability`.",
                "type": "number",
                "exclusiveMinimum": 0,
                "exclusiveMaximum": 1,
            },
        },
        "required": ["all"],
        "additionalProperties": false,
    })
}

fn published() -> Json {
    json!({
        "description": "Published results, shown beside those of a study.",
        "type": "object",
        "properties": {
            "source": {
                "description": "Source of the results.",
                "type": "string",
                "minLength": 1,
            },
            "choice": {
                "description": "The team size that the source recommends.",
                "type": "integer",
                "minimum": 1,
            },
            "time_limit_s": {
                "description": "Time limit of the published runs; a run with this time failed.",
                "type": "number",
                "minimum": 0,
                "maximum": MAX_TIME_LIMIT_S,
            },
            "times_s": {
                "description": "Times of the runs, by team size.",
                "type": "object",
                "additionalProperties": {
                    "type": "array",
                    "items": { "type": "number", "minimum": 0, "maximum": MAX_TIME_LIMIT_S },
                    "minItems": 2,
                },
            },
        },
        "required": ["source", "choice", "time_limit_s", "times_s"],
        "additionalProperties": false,
    })
}
