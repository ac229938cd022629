//! Belief-based brains in the simulator.

mod canyon;
mod crossing;
mod errands;
mod home;
mod moving;
mod searching;

use base::geometry::Point;

/// Points as a list in a scenario.
fn listed(places: &[Point]) -> String {
    let each = places
        .iter()
        .map(|place| format!("[{}, {}]", place.x, place.y));
    format!("[{}]", each.collect::<Vec<_>>().join(", "))
}
