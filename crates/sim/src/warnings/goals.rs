//! Warnings about goals without controllers, which robots serve only on waypoints of their own.

use super::economy::owner_of;
use crate::bodies::RobotSpec;
use crate::goals::GoalSpec;
use crate::scenario::{Checked, ScenarioSpec};
use base::document::Place;
use base::geometry::Point;
use base::placement::Placement;
use base::warning::Warning;
use brain::behaviours::{BehaviourSpec, Navigate};

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    // A program may command robots without behaviours.
    let mut robots = spec.robots.values();
    if robots.any(|robot| robot.count > 0 && robot.brain.behaviours.is_empty()) {
        return Vec::new();
    }
    let goals = spec
        .goals
        .iter()
        .filter(|(_, kind)| kind.count > 0 && !has_owner(kind, spec));
    goals
        .filter_map(|(name, kind)| of_goals(kind, spec, &at.key("goals").key(name)))
        .collect()
}

/// Whether there are controllers that own such goals: others than the kind that is to own them, if there are none of it.
fn has_owner(kind: &GoalSpec, spec: &ScenarioSpec) -> bool {
    let mut controllers = spec.controllers.values();
    owner_of(kind, spec).is_some() && controllers.any(|controllers| controllers.count > 0)
}

fn of_goals(kind: &GoalSpec, spec: &ScenarioSpec, at: &Place) -> Option<Warning> {
    let places: &[Point] = match &kind.placement {
        Placement::Fixed { at_m, .. } => at_m,
        _ => &[],
    };
    let robots = spec.robots.values().filter(|robot| robot.count > 0);
    let mut visits = robots.flat_map(visits);
    if !visits.any(|visit| visit.waypoints_m == places) {
        return Some(at.warning(
            "no robot serves them: there are no controllers to award them, and no behaviour navigate whose \
             waypoints_m are their positions"
                .to_owned(),
        ));
    }
    (kind.service_s > 0.0).then(|| {
        let effect = "without controllers, robots leave before these goals are served: the behaviour navigate does \
                      not stay at its waypoints";
        at.key("service_s").warning(effect.to_owned())
    })
}

/// The behaviours of a robot that visit waypoints.
fn visits(robot: &RobotSpec) -> impl Iterator<Item = &Navigate> {
    let behaviours = robot.brain.behaviours.iter();
    behaviours.filter_map(|behaviour| match behaviour {
        BehaviourSpec::Navigate(navigate) => Some(navigate),
        _ => None,
    })
}
