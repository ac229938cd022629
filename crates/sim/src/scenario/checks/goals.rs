//! Checks of goals: their owners, the robots that can serve them, and their timetables.

use super::controllers::unknown;
use crate::bodies::RobotSpec;
use crate::goals::GoalSpec;
use crate::scenario::counts::max_count;
use crate::scenario::finders::can_serve;
use crate::scenario::spec::ScenarioSpec;
use base::document::{Document, Place};
use base::error::InputError;
use base::placement::Placement;
use brain::behaviours::BehaviourSpec;
use std::collections::BTreeSet;

/// Maximum number of different capabilities: messages number them in one byte.
const MAX_CAPABILITIES: usize = 255;

pub(super) fn errors(spec: &ScenarioSpec, document: &Document) -> Vec<InputError> {
    let at = &document.place();
    let mut errors = of_capabilities(spec, at);
    for (name, kind) in &spec.goals {
        let at = at.key("goals").key(name);
        errors.extend(of_owner(kind, spec, &at));
        let of_servers = of_servers(kind, spec, &at);
        if of_servers.is_none() {
            errors.extend(of_assignees((name, kind), spec, document));
        }
        errors.extend(of_servers);
        errors.extend(of_deadline(kind, &at));
        errors.extend(of_timetable(kind, spec, &at));
    }
    errors.extend(of_twins(spec, at));
    errors
}

/// Capabilities that a kind of robots has twice, and too many of them.
fn of_capabilities(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    for (name, robot) in &spec.robots {
        let at = at.key("robots").key(name).key("capabilities");
        let mut known = BTreeSet::new();
        let twice = robot.capabilities.iter().enumerate();
        let twice = twice.filter(|(_, name)| !known.insert(*name));
        errors.extend(twice.map(|(number, _)| {
            at.item(number)
                .error("a capability that is not listed before")
        }));
    }
    if spec.capabilities().len() > MAX_CAPABILITIES {
        let allowed =
            format!("with at most {MAX_CAPABILITIES} different capabilities of all kinds together");
        errors.push(at.key("robots").error(allowed));
    }
    errors
}

/// An owner that does not exist, or is missing where there are several kinds of controllers.
fn of_owner(kind: &GoalSpec, spec: &ScenarioSpec, at: &Place) -> Option<InputError> {
    let at = at.key("owner");
    match &kind.owner {
        Some(owner) if !spec.controllers.contains_key(owner) => {
            Some(unknown(owner, spec.controllers.keys(), &at))
        }
        None if spec.controllers.len() > 1 => {
            let names: Vec<String> = spec
                .controllers
                .keys()
                .map(|name| format!("{name:?}"))
                .collect();
            Some(at.error(format!("one of {}", names.join(", "))))
        }
        _ => None,
    }
}

/// Goals that no kind of robots can serve, whatever their number, which a study may vary.
fn of_servers(kind: &GoalSpec, spec: &ScenarioSpec, at: &Place) -> Option<InputError> {
    let capabilities = spec.capabilities();
    if let Some(required) = &kind.requires
        && !capabilities.contains(required)
    {
        return Some(unknown(required, capabilities.iter(), &at.key("requires")));
    }
    let is_served = spec.robots.values().any(|robot| can_serve(robot, kind));
    (!is_served).then(|| {
        at.error(
            "a kind of goal that a kind of robots can serve: none has a radio and the capability \
             that it requires",
        )
    })
}

/// Goals that controllers own and can award to no robot, in any configuration of the study.
fn of_assignees(
    (name, kind): (&String, &GoalSpec),
    spec: &ScenarioSpec,
    document: &Document,
) -> Option<InputError> {
    let exist = |table: &str, name: &str| max_count(document, table, name) > 0;
    let owner = kind.owner.as_ref().or(spec.controllers.keys().next());
    if !exist("goals", name) || !owner.is_some_and(|owner| exist("controllers", owner)) {
        return None;
    }
    let robots = spec.robots.iter();
    let robots = robots.filter(|(name, robot)| exist("robots", name) && can_be_awarded(robot));
    let robots: Vec<&RobotSpec> = robots.map(|(_, robot)| robot).collect();
    if robots.iter().any(|robot| can_serve(robot, kind)) {
        return None;
    }
    let at = document.place().key("goals").key(name);
    let Some(required) = kind.requires.as_ref().filter(|_| !robots.is_empty()) else {
        return Some(at.error(
            "a kind of goal that controllers can award: no kind of robots with a count above 0 has a radio and \
             the behaviour serve, as in behaviours = [{ kind = \"serve\" }]",
        ));
    };
    let capabilities = robots.iter().flat_map(|robot| &robot.capabilities);
    let capabilities: BTreeSet<&String> = capabilities.collect();
    let error = unknown(required, capabilities.iter().copied(), &at.key("requires"));
    let allowed = error.allowed + " among capabilities of robots with the behaviour serve";
    Some(InputError { allowed, ..error })
}

/// Whether controllers can award goals to such robots. Those without behaviours are driven by a program.
fn can_be_awarded(robot: &RobotSpec) -> bool {
    let behaviours = &robot.brain.behaviours;
    let serves = behaviours.is_empty() || behaviours.iter().any(BehaviourSpec::serves_controllers);
    serves && robot.radio.is_some()
}

/// Goals that expire before they can be served.
fn of_deadline(kind: &GoalSpec, at: &Place) -> Option<InputError> {
    let deadline_s = kind.deadline_s?;
    let service_s = kind.service_s;
    (deadline_s < service_s).then(|| {
        let allowed =
            format!("at least service_s = {service_s}: these goals expire before they are served");
        at.key("deadline_s").error(allowed)
    })
}

/// Goals that arrive after the end of a run.
fn of_timetable(kind: &GoalSpec, spec: &ScenarioSpec, at: &Place) -> Option<InputError> {
    let limit_s = spec.clock.time_limit_s;
    if kind.count == 0 {
        return None;
    }
    if kind.arrive_s > limit_s {
        let allowed = format!("at most time_limit_s = {limit_s}");
        return Some(at.key("arrive_s").error(allowed));
    }
    let intervals = f64::from(kind.count - 1);
    let last_s = kind.arrive_s + intervals * kind.every_s;
    (last_s > limit_s).then(|| {
        let allowed = format!(
            "at most {}: the last of {} goals must arrive within time_limit_s = {limit_s}",
            (limit_s - kind.arrive_s) / intervals,
            kind.count
        );
        at.key("every_s").error(allowed)
    })
}

/// Kinds whose goals would have the same ids, because they have the same positions.
fn of_twins(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let mut known: Vec<(&String, &Placement)> = Vec::new();
    let mut errors = Vec::new();
    for (name, kind) in &spec.goals {
        let Placement::Fixed { at_m, .. } = &kind.placement else {
            continue;
        };
        let same = known.iter().find(|(_, placement)| {
            matches!(placement, Placement::Fixed { at_m: other, .. } if other == at_m)
        });
        if let Some((other, _)) = same {
            let at = at.key("goals").key(name).key("placement").key("at_m");
            errors.push(at.error(format!(
                "other positions than those of {other}: goals with the same positions are the same"
            )));
        }
        known.push((name, &kind.placement));
    }
    errors
}
