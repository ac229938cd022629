//! Documents of scenarios that state only what a test is about.

use base::document::{Document, Value};
use base::error::InputErrors;
use sim::scenario::{Scenario, ScenarioSpec};
use std::sync::Arc;

const WORLD: &str = "clock.time_limit_s = 60\nworld.size_m = [20, 10]";

const DRIVE: &str = "drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }";

/// What separates changes from the document that they change.
const CHANGED: &str = "\n# Values that do not change:\n";

/// The scenario of a document without errors.
pub(crate) fn scenario(text: &str) -> Arc<Scenario> {
    Arc::new(read(text).unwrap_or_else(|errors| panic!("{errors}\n{text}")))
}

/// The scenario of a document, or its errors.
///
/// A world without a size is 20 m x 10 m large, and a run without a limit takes 60 s. A robot
/// without a model has a radius of 0.2 m and drives at 1 m/s and 90 degrees per second. A kind with
/// places is `fixed` at them. It has as many members as places, or one, if it states no `count`.
pub(crate) fn read(text: &str) -> Result<Scenario, InputErrors> {
    let mut document = Document::default();
    for part in text.split(CHANGED) {
        let mut part = Document::parse("t.toml", part)?;
        each_kind(&mut part, fill_places);
        document.fill(&[], &part);
    }
    each_kind(&mut document, fill_kind);
    document.fill(&[], &parsed(WORLD));
    Ok(ScenarioSpec::read(&document)?.scenario)
}

/// A document with other values at some keys.
pub(crate) fn with(text: &str, changes: &str) -> String {
    format!("{changes}{CHANGED}{text}")
}

fn each_kind(document: &mut Document, fill: impl Fn(&mut Document, [&str; 3])) {
    for (table, places) in [
        ("controllers", "start"),
        ("goals", "placement"),
        ("items", "placement"),
        ("robots", "start"),
    ] {
        let kinds = document.get(&[table]).map(|node| node.value.clone());
        let Some(Value::Table(kinds)) = kinds else {
            continue;
        };
        for name in kinds.keys() {
            fill(document, [table, name, places]);
        }
    }
}

fn fill_places(document: &mut Document, places @ [table, name, key]: [&str; 3]) {
    if document.get(&[table, name, key, "at_m"]).is_some() {
        document.fill(&places, &parsed("kind = \"fixed\""));
    }
}

fn fill_kind(document: &mut Document, [table, name, places]: [&str; 3]) {
    let kind = [table, name];
    if table == "robots" && document.get(&[table, name, "model"]).is_none() {
        document.fill(&kind, &parsed("radius_m = 0.2"));
        // A drive that is stated keeps the default values of its other keys.
        if document.get(&[table, name, "drive"]).is_none() {
            document.fill(&kind, &parsed(DRIVE));
        }
    }
    let at_m = document.get(&[table, name, places, "at_m"]);
    let count = match at_m.map(|node| &node.value) {
        Some(Value::List(at_m)) => at_m.len(),
        _ => 1,
    };
    document.fill(&kind, &parsed(&format!("count = {count}")));
}

fn parsed(text: &str) -> Document {
    Document::parse("defaults", text).unwrap()
}
