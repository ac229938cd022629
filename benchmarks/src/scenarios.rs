//! Scenarios from TOML text.

use base::document::Document;
use sim::scenario::{Scenario, ScenarioSpec};

/// Reads a scenario without errors.
pub(crate) fn read(name: &str, text: &str) -> Scenario {
    let document = Document::parse(name, text).expect("it is TOML");
    let checked = ScenarioSpec::read(&document).map_err(|errors| errors.to_string());
    checked.expect("it has no errors").scenario
}
