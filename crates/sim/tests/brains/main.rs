//! Belief-based brains in the simulator.

#![expect(
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test may fail by a panic"
)]

mod canyon;
mod crossing;
mod economy;
mod errands;
mod home;
mod moving;
mod searching;

use base::document::Document;
use base::geometry::Point;
use sim::scenario::{Scenario, ScenarioSpec};
use std::sync::Arc;

/// The scenario of a document without errors.
fn scenario(text: &str) -> Arc<Scenario> {
    let document = Document::parse("test.toml", text).unwrap();
    match ScenarioSpec::read(&document) {
        Ok(checked) => Arc::new(checked.scenario),
        Err(errors) => panic!("{errors}\n{text}"),
    }
}

/// Points as a list in a scenario.
fn listed(places: &[Point]) -> String {
    let each = places
        .iter()
        .map(|place| format!("[{}, {}]", place.x, place.y));
    format!("[{}]", each.collect::<Vec<_>>().join(", "))
}
