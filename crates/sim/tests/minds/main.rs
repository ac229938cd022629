//! What robots with minds do in the simulator: one thing a file.

#![expect(
    clippy::panic,
    clippy::unwrap_used,
    reason = "tests panic when what they ask for is wrong"
)]

mod canyon;
mod crossing;
mod errands;
mod home;
mod moving;
mod searching;

use base::document::Document;
use base::geometry::Point;
use sim::scenario::{Scenario, ScenarioSpec};
use std::sync::Arc;

/// A scenario without errors.
fn scenario(text: &str) -> Arc<Scenario> {
    let document = Document::parse("test.toml", text).unwrap();
    match ScenarioSpec::read(&document) {
        Ok(checked) => Arc::new(checked.scenario),
        Err(errors) => panic!("{errors}\n{text}"),
    }
}

/// Places as a scenario has them.
fn listed(places: &[Point]) -> String {
    let each = places
        .iter()
        .map(|place| format!("[{}, {}]", place.x, place.y));
    format!("[{}]", each.collect::<Vec<_>>().join(", "))
}
