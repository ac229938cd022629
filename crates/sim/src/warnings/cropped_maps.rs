//! Warnings about maps with occupied cells outside of the world.

use crate::scenario::Checked;
use crate::world::obstacles::Solid;
use base::document::Place;
use base::geometry::{Point, Rectangle};
use base::map::OccupancyMap;
use base::warning::Warning;

/// Places and sizes are advised in multiples of this, in metres: less than half a cell.
const UNIT_M: f64 = 1e-5;

/// Less than this, in units, is rounding.
const TOLERANCE: f64 = 1e-3;

/// Maps whose free or unknown margin alone is outside have no warning.
pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let world = checked.scenario.world();
    let at = at.key("world").key("obstacles");
    let cropped = checked.scenario.obstacles().filter_map(|(index, solid)| {
        let Solid::Map(map) = solid else { return None };
        let effect = effect(map, world)?;
        Some(at.item(index).key("map").warning(effect))
    });
    cropped.collect()
}

fn effect(map: &OccupancyMap, world: Rectangle) -> Option<String> {
    let bounds = map.bounds();
    if world.contains(bounds.min()) && world.contains(bounds.max()) {
        return None;
    }
    let (occupied, outside) = map.occupied_and_outside(world);
    (outside > 0).then(|| {
        let share = share(outside, occupied);
        let Point { x, y } = world.max();
        format!(
            "{share} of its occupied cells are outside of the world, from [0, 0] to [{x}, {y}], and are \
             ignored; {} holds all of the map",
            advice(map, world)
        )
    })
}

/// A share in percent; at least 1 %, and 100 % of all only.
fn share(outside: usize, occupied: usize) -> String {
    let percent = (100 * outside + occupied / 2) / occupied;
    let most = if outside == occupied { 100 } else { 99 };
    format!("{}%", percent.clamp(1, most))
}

/// The keys with which the whole map is in the world.
fn advice(map: &OccupancyMap, world: Rectangle) -> String {
    let (bounds, size) = (map.bounds(), world.size());
    let (low, high, origin) = (bounds.min(), bounds.max(), map.origin());
    let (right, up) = (rounded_up(-low.x), rounded_up(-low.y));
    let mut advice = Vec::new();
    if high.x + right > size.x + UNIT_M || high.y + up > size.y + UNIT_M {
        let width = size.x.max(rounded_up(high.x + right));
        let height = size.y.max(rounded_up(high.y + up));
        advice.push(format!("world.size_m = [{width}, {height}]"));
    }
    if right > 0.0 || up > 0.0 {
        let (x, y) = (rounded_up(origin.x + right), rounded_up(origin.y + up));
        advice.push(format!("at_m = [{x}, {y}]"));
    }
    advice.join(" with ")
}

/// The next multiple of the unit that is at least a number, and at least 0.
fn rounded_up(metres: f64) -> f64 {
    let units = (metres / UNIT_M - TOLERANCE).ceil().max(0.0);
    // Dividing by a whole number gives the shortest decimal.
    units / (1.0 / UNIT_M).round()
}
