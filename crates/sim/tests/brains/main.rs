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
#[path = "../scenarios/mod.rs"]
mod scenarios;
mod searching;

use base::geometry::Point;

/// Points as a list in a scenario.
fn listed(places: &[Point]) -> String {
    let each = places
        .iter()
        .map(|place| format!("[{}, {}]", place.x, place.y));
    format!("[{}]", each.collect::<Vec<_>>().join(", "))
}
