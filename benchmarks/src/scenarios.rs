//! Scenarios as files have them.

use base::document::Document;
use sim::scenario::{Scenario, ScenarioSpec};

/// Reads one that has no faults.
pub(crate) fn read(name: &str, text: &str) -> Scenario {
    let document = Document::parse(name, text).expect("it is TOML");
    let checked = ScenarioSpec::read(&document).map_err(|faults| faults.to_string());
    checked.expect("it has no faults").scenario
}
