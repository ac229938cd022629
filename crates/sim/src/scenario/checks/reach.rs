//! Checks that robots can reach the items and goals.

use crate::bodies::{Layer, RobotSpec};
use crate::scenario::areas::{lattice, within};
use crate::scenario::checked::Checked;
use crate::scenario::finders::{Finder, finders, reach, servers};
use base::document::Place;
use base::error::InputError;
use base::geometry::Point;
use base::placement::Placement;
use base::reachability::Reachability;

/// A kind counts whatever its number of robots, which a study may vary.
pub(super) fn errors(checked: &Checked, at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    let target = checked
        .spec
        .items
        .iter()
        .filter(|(_, kind)| kind.target && kind.count > 0);
    for (name, kind) in target {
        let at = at.key("items").key(name);
        let finders: Vec<Finder> = finders(&checked.spec, name);
        if finders.is_empty() {
            let allowed = "a kind of item that a robot can detect: none has a sensor of kind \"items\" for \
                           it; for clutter, set target = false";
            errors.push(at.error(allowed));
        }
        // Paths through a periodic world are not examined.
        if !finders.is_empty() && !checked.spec.world.periodic {
            let targets = Targets {
                placement: &kind.placement,
                count: kind.max_number(),
                robots: "robot with a sensor for it",
            };
            errors.extend(out_of_reach(checked, &targets, &finders, &at));
            errors.extend(all_out_of_reach(checked, &targets, &finders, &at));
        }
    }
    errors.extend(of_goals(checked, at));
    errors
}

/// Goals that no robot that can serve them can reach.
fn of_goals(checked: &Checked, at: &Place) -> Vec<InputError> {
    let spec = &checked.spec;
    let goals = spec.goals.iter().filter(|(_, kind)| kind.count > 0);
    let goals = goals.filter(|_| !spec.world.periodic);
    let errors = goals.flat_map(|(name, kind)| {
        let at = at.key("goals").key(name);
        let servers = servers(spec, kind);
        // Goals that no robot can serve anywhere are reported by another check.
        if servers.is_empty() {
            return Vec::new();
        }
        let targets = Targets {
            placement: &kind.placement,
            count: kind.count,
            robots: "robot that can serve it",
        };
        let mut errors = out_of_reach(checked, &targets, &servers, &at);
        errors.extend(all_out_of_reach(checked, &targets, &servers, &at));
        errors
    });
    errors.collect()
}

/// Items or goals of a kind.
struct Targets<'s> {
    placement: &'s Placement,
    count: u32,
    /// The robots that have to come near.
    robots: &'static str,
}

/// The given places that no robot can come near enough to.
fn out_of_reach(
    checked: &Checked,
    kind: &Targets,
    finders: &[Finder],
    at: &Place,
) -> Vec<InputError> {
    let Placement::Fixed { at_m, .. } = kind.placement else {
        return Vec::new();
    };
    let reaches: Vec<(Reachability, f64)> = finders
        .iter()
        .map(|finder| (reach(checked, finder.robot), finder.range_m))
        .collect();
    let at = at.key("placement").key("at_m");
    let is_found = |place: Point| {
        reaches
            .iter()
            .any(|(reach, range_m)| reach.may_come_near(place, *range_m))
    };
    let places = at_m.iter().take(kind.count as usize).enumerate();
    places
        .filter(|(_, place)| !is_found(**place))
        .map(|(index, _)| {
            let allowed = format!("a place that a {} can reach within range", kind.robots);
            at.item(index).error(allowed)
        })
        .collect()
}

/// Randomly placed items, if no robot can come near enough to any place of their area.
fn all_out_of_reach(
    checked: &Checked,
    kind: &Targets,
    finders: &[Finder],
    at: &Place,
) -> Option<InputError> {
    let within = within(kind.placement, checked.scenario.world())?;
    let is_free = |place: &Point| checked.scenario.is_free(*place, 0.0, Layer::Ground);
    let places = || lattice(within).filter(is_free);
    // Where there is no free place at all, another check reports it.
    let is_fine = places().next().is_none()
        || finders
            .iter()
            .any(|finder| starts_at_one(checked, finder.robot, places()))
        || finders.iter().any(|finder| {
            let reach = reach(checked, finder.robot);
            places().any(|place| reach.may_come_near(place, finder.range_m))
        });
    let at = match kind.placement {
        Placement::Uniform { within_m: Some(_) }
        | Placement::Clustered {
            within_m: Some(_), ..
        } => at.key("placement").key("within_m"),
        _ => at.key("placement"),
    };
    let allowed = format!(
        "an area with a free place that a {} can reach within range: it has none",
        kind.robots
    );
    (!is_fine).then(|| at.error(allowed))
}

/// Whether a robot may start on one of these places: mostly so, and faster to see than where it may
/// move.
fn starts_at_one(
    checked: &Checked,
    robot: &RobotSpec,
    mut places: impl Iterator<Item = Point>,
) -> bool {
    let start = within(&robot.start, checked.scenario.world());
    start.is_some_and(|start| {
        places.any(|place| {
            start.contains(place) && checked.scenario.is_free(place, robot.radius_m, robot.layer)
        })
    })
}
