//! Checks that there is room for everything that is placed at random.

use super::ground::rectangle;
use crate::bodies::{Layer, RobotSpec};
use crate::scenario::areas::{SIDE, lattice, within};
use crate::scenario::checked::Checked;
use crate::scenario::ready::Scenario;
use base::document::Place;
use base::error::InputError;
use base::geometry::Rectangle;
use base::placement::Placement;
use std::f64::consts::PI;

/// Discs of one size that are placed one by one at random jam when they cover 0.547 of the plane
/// (Feder, *Random sequential adsorption*, 1980); long before that, a free place is hard to find.
const MAX_SHARE: f64 = 0.5;

/// Whether a rectangle has a place for a disc.
fn has_place(scenario: &Scenario, within: Rectangle, radius_m: f64, layer: Layer) -> bool {
    lattice(within).any(|place| scenario.is_free(place, radius_m, layer))
}

/// The free area of a rectangle, examined until it is at least `enough_m2`.
fn free_area_m2(scenario: &Scenario, within: Rectangle, layer: Layer, enough_m2: f64) -> f64 {
    let place_m2 = within.area_m2() / f64::from(SIDE * SIDE);
    let mut free = lattice(within).filter(|place| scenario.is_free(*place, 0.0, layer));
    let mut free_m2 = 0.0;
    while free_m2 < enough_m2 && free.next().is_some() {
        free_m2 += place_m2;
    }
    free_m2
}

pub(super) fn errors(checked: &Checked, at: &Place) -> Vec<InputError> {
    let world = rectangle(&checked.spec.world);
    let scenario = &checked.scenario;
    let mut errors = Vec::new();
    for (placement, count, at) in points(checked, at) {
        let within = within(placement, world).filter(|_| count > 0);
        if within.is_some_and(|within| !has_place(scenario, within, 0.0, Layer::Ground)) {
            errors.push(at.key("count").error("0: their area has no free place"));
        }
    }
    let mut is_fine = true;
    for (name, kind) in &checked.spec.robots {
        let at = at.key("robots").key(name);
        let error = error_of(kind, checked, &at);
        is_fine &= error.is_none();
        errors.extend(error);
    }
    if is_fine {
        let layers = [Layer::Ground, Layer::Air];
        errors.extend(
            layers
                .into_iter()
                .filter_map(|layer| crowd(checked, layer, at)),
        );
    }
    errors
}

/// The placement and number of each kind of things without a size.
fn points<'c, 'd>(
    checked: &'c Checked,
    at: &Place<'d>,
) -> impl Iterator<Item = (&'c Placement, u32, Place<'d>)> {
    let spec = &checked.spec;
    let tables = ["items", "goals", "controllers"].map(|table| at.key(table));
    let [items, goals, controllers_at] = tables;
    let items = spec
        .items
        .iter()
        .map(move |(name, kind)| (&kind.placement, kind.count, items.key(name)));
    let goals = spec
        .goals
        .iter()
        .map(move |(name, kind)| (&kind.placement, kind.count, goals.key(name)));
    let controllers = spec.controllers.iter();
    let controllers = controllers.filter_map(move |(name, kind)| {
        Some((kind.start.as_ref()?, kind.count, controllers_at.key(name)))
    });
    items.chain(goals).chain(controllers)
}

/// There is a place for one robot of the kind.
fn error_of(kind: &RobotSpec, checked: &Checked, at: &Place) -> Option<InputError> {
    let scenario = &checked.scenario;
    let within = within(&kind.start, scenario.world()).filter(|_| kind.count > 0)?;
    (!has_place(scenario, within, kind.radius_m, kind.layer)).then(|| {
        let radius_m = kind.radius_m;
        at.key("count").error(format!(
            "0: none of {} examined start places is free for radius_m = {radius_m}",
            SIDE * SIDE
        ))
    })
}

/// All robots of a layer have room beside each other.
fn crowd(checked: &Checked, layer: Layer, at: &Place) -> Option<InputError> {
    let kinds = checked
        .spec
        .robots
        .iter()
        .filter(|(_, kind)| kind.layer == layer);
    let areas = kinds.map(|(name, kind)| {
        let area_m2 = f64::from(kind.count) * PI * kind.radius_m * kind.radius_m;
        (area_m2, name, kind)
    });
    let areas: Vec<(f64, &String, &RobotSpec)> = areas.collect();
    let total_m2: f64 = areas.iter().map(|(area_m2, ..)| area_m2).sum();
    let world = rectangle(&checked.spec.world);
    let enough_m2 = total_m2 / MAX_SHARE;
    let free_m2 = free_area_m2(&checked.scenario, world, layer, enough_m2);
    let largest = areas.iter().max_by(|one, other| one.0.total_cmp(&other.0));
    let (area_m2, name, _) = largest.filter(|_| free_m2 < enough_m2)?;
    let share = MAX_SHARE * 100.0;
    let allowed = format!(
        "fewer: randomly placed robots can cover {share} % of the {free_m2:.0} m2 of free area, but all {} \
         robots would cover {total_m2:.0} m2, these alone {area_m2:.0} m2",
        match layer {
            Layer::Ground => "ground",
            Layer::Air => "air",
        }
    );
    Some(at.key("robots").key(name).key("count").error(allowed))
}
