//! Checks that given places are free.

use super::ground::{rectangle, words};
use crate::bodies::{Layer, RobotSpec};
use crate::scenario::checked::Checked;
use crate::scenario::spec::ScenarioSpec;
use base::document::Place;
use base::error::InputError;
use base::geometry::{Point, Rectangle, Torus};
use base::placement::Placement;

/// Robots nearer to each other than this, in metres, overlap; less is rounding.
const TOLERANCE_M: f64 = 1e-9;

pub(super) fn errors(checked: &Checked, at: &Place) -> Vec<InputError> {
    let spec = &checked.spec;
    let mut errors = Vec::new();
    for (name, kind) in &spec.items {
        let at = at.key("items").key(name).key("placement");
        errors.extend(errors_of_points(
            checked,
            (&kind.placement, kind.max_number()),
            &at,
        ));
    }
    for (name, kind) in &spec.goals {
        let at = at.key("goals").key(name).key("placement");
        errors.extend(errors_of_points(
            checked,
            (&kind.placement, kind.count),
            &at,
        ));
    }
    for (name, kind) in &spec.controllers {
        let at = at.key("controllers").key(name).key("start");
        let start = kind.start.iter();
        errors.extend(start.flat_map(|start| errors_of_points(checked, (start, kind.count), &at)));
    }
    for (name, kind) in &spec.robots {
        let at = at.key("robots").key(name).key("start");
        errors.extend(errors_of_list(&kind.start, kind.count, &at));
        errors.extend(errors_of_rectangle(&kind.start, spec, &at));
        for (place, at) in given(&kind.start, kind.count, &at) {
            if !checked.scenario.is_free(place, kind.radius_m, kind.layer) {
                errors.push(at.error(not_free(kind, spec)));
            }
        }
    }
    errors.extend(overlaps(spec, checked.scenario.torus, at));
    errors
}

/// Errors of the places of things without a size on the ground.
fn errors_of_points(
    checked: &Checked,
    (placement, count): (&Placement, u32),
    at: &Place,
) -> Vec<InputError> {
    let spec = &checked.spec;
    let mut errors = errors_of_list(placement, count, at);
    errors.extend(errors_of_rectangle(placement, spec, at));
    for (place, at) in given(placement, count, at) {
        if !checked.scenario.is_free(place, 0.0, Layer::Ground) {
            let world = words(&spec.world);
            errors.push(at.error(format!("in {world}, and not in an obstacle")));
        }
    }
    errors
}

fn not_free(kind: &RobotSpec, spec: &ScenarioSpec) -> String {
    let obstacles = match kind.layer {
        Layer::Ground => " and from any obstacle",
        Layer::Air => "",
    };
    let world = words(&spec.world);
    let radius_m = kind.radius_m;
    if spec.world.periodic {
        return format!("in {world}, at least radius_m = {radius_m} from any obstacle");
    }
    format!("in {world}, at least radius_m = {radius_m} from its border{obstacles}")
}

/// The places that are given to existing robots or items.
fn given<'d>(placement: &Placement, count: u32, at: &Place<'d>) -> Vec<(Point, Place<'d>)> {
    let places = match placement {
        Placement::Fixed { at_m, .. } => at_m.as_slice(),
        _ => &[],
    };
    let at = at.key("at_m");
    let places = places.iter().take(count as usize).enumerate();
    places
        .map(|(index, place)| (*place, at.item(index)))
        .collect()
}

/// There are enough places, and as many headings as places.
fn errors_of_list(placement: &Placement, count: u32, at: &Place) -> Vec<InputError> {
    let Placement::Fixed { at_m, heading_deg } = placement else {
        return Vec::new();
    };
    let mut errors = Vec::new();
    if at_m.len() < count as usize {
        let allowed = format!(
            "a list of at least {count} places, the count; it has {}",
            at_m.len()
        );
        errors.push(at.key("at_m").error(allowed));
    }
    if heading_deg
        .as_ref()
        .is_some_and(|given| given.len() != at_m.len())
    {
        let allowed = format!("a list of {} headings, one for each place", at_m.len());
        errors.push(at.key("heading_deg").error(allowed));
    }
    errors
}

fn errors_of_rectangle(
    placement: &Placement,
    spec: &ScenarioSpec,
    at: &Place,
) -> Option<InputError> {
    let (Placement::Uniform { within_m } | Placement::Clustered { within_m, .. }) = placement
    else {
        return None;
    };
    let world = rectangle(&spec.world);
    let is_in = |within: &Rectangle| world.contains(within.min()) && world.contains(within.max());
    let is_bad = within_m.as_ref().is_some_and(|within| !is_in(within));
    is_bad.then(|| {
        at.key("within_m")
            .error(format!("two corners in {}", words(&spec.world)))
    })
}

/// A robot with a given place.
struct Standing<'d> {
    place: Point,
    radius_m: f64,
    layer: Layer,
    at: Place<'d>,
    /// Where its image is, in a periodic world.
    is_image: bool,
}

/// Given places at which robots would overlap.
fn overlaps(spec: &ScenarioSpec, torus: Option<Torus>, at: &Place) -> Vec<InputError> {
    let standing = spec.robots.iter().flat_map(|(name, kind)| {
        let at = at.key("robots").key(name).key("start");
        given(&kind.start, kind.count, &at)
            .into_iter()
            .map(|(place, at)| Standing {
                place,
                radius_m: kind.radius_m,
                layer: kind.layer,
                at,
                is_image: false,
            })
    });
    let mut standing: Vec<Standing> = standing.collect();
    if let Some(torus) = torus {
        let images: Vec<Standing> = standing.iter().flat_map(|one| images(one, torus)).collect();
        standing.extend(images);
    }
    // Sorted by x, only those that begin before one ends can overlap it.
    standing.sort_by(|one, other| left(one).total_cmp(&left(other)));
    let first_overlap = |(index, one): (usize, &Standing)| {
        let right = one.place.x + one.radius_m;
        let after = standing[index + 1..].iter();
        let mut near = after.take_while(|other| left(other) < right);
        let other = near.find(|other| !other.is_image && overlap(one, other))?;
        let Point { x, y } = one.place;
        let radii_m = one.radius_m + other.radius_m;
        Some(
            other
                .at
                .error(format!("at least {radii_m} from the robot at [{x}, {y}]")),
        )
    };
    standing
        .iter()
        .enumerate()
        .filter_map(first_overlap)
        .collect()
}

fn images<'d>(one: &Standing<'d>, torus: Torus) -> impl Iterator<Item = Standing<'d>> {
    let images = torus.images_within(one.place, one.radius_m);
    images.map(|place| Standing {
        place,
        at: one.at.clone(),
        is_image: true,
        ..*one
    })
}

fn left(robot: &Standing) -> f64 {
    robot.place.x - robot.radius_m
}

fn overlap(one: &Standing, other: &Standing) -> bool {
    let reach_m = one.radius_m + other.radius_m - TOLERANCE_M;
    one.layer == other.layer && one.place.to(other.place).length() < reach_m
}
