//! Warnings about goals that controllers own and that no robot will serve.

use crate::bodies::RobotSpec;
use crate::controllers::ControllerSpec;
use crate::goals::GoalSpec;
use crate::scenario::{Checked, ScenarioSpec};
use crate::sensors::sensor_kind::Provides;
use base::document::Place;
use base::warning::Warning;
use brain::Work;
use brain::behaviours::BehaviourSpec;
use economy::Allocation;

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    if !spec.controllers.values().any(|kind| kind.count > 0) || goals(spec).next().is_none() {
        return Vec::new();
    }
    let of_kinds = owners(spec).flat_map(|(name, kind)| {
        let at = at.key("controllers").key(name);
        let found = [of_allocation(kind, spec, &at), of_maximum(kind, &at)];
        found.into_iter().flatten()
    });
    of_failures(spec, at)
        .into_iter()
        .chain(of_kinds)
        .chain(of_searches(spec, at))
        .collect()
}

/// The kinds of controllers that own goals, by their names.
pub(super) fn owners(spec: &ScenarioSpec) -> impl Iterator<Item = (&String, &ControllerSpec)> + '_ {
    let kinds = spec.controllers.iter().filter(|(_, kind)| kind.count > 0);
    kinds.filter(|(name, _)| goals(spec).any(|(_, goal)| owner_of(goal, spec) == Some(name)))
}

/// The kinds of goals that there are, by their names.
fn goals(spec: &ScenarioSpec) -> impl Iterator<Item = (&String, &GoalSpec)> {
    spec.goals.iter().filter(|(_, kind)| kind.count > 0)
}

/// The name of the kind of controllers that own goals of a kind.
pub(super) fn owner_of<'s>(kind: &'s GoalSpec, spec: &'s ScenarioSpec) -> Option<&'s String> {
    kind.owner.as_ref().or(spec.controllers.keys().next())
}

/// All controllers, or all robots, that do not work from the start.
fn of_failures(spec: &ScenarioSpec, at: &Place) -> Vec<Warning> {
    let is_out = |count: u32, lists: [&[u32]; 2]| {
        (0..count).all(|index| lists.iter().any(|list| list.contains(&index)))
    };
    let mut kinds = spec.controllers.values();
    let mut found = Vec::new();
    if kinds.all(|kind| is_out(kind.count, [&kind.failed, &[]])) {
        let effect = "all controllers have failed from the start: no goal is awarded";
        found.push(at.key("controllers").warning(effect.to_owned()));
    }
    let mut kinds = spec.robots.values();
    if kinds.all(|kind| is_out(kind.count, [&kind.failed, &kind.out_of_service])) {
        let effect =
            "all robots have failed or are out of service from the start: no goal is served";
        found.push(at.key("robots").warning(effect.to_owned()));
    }
    found
}

/// Controllers that award nothing, to robots that visit no waypoints of their own.
fn of_allocation(kind: &ControllerSpec, spec: &ScenarioSpec, at: &Place) -> Option<Warning> {
    let visits = |behaviour: &BehaviourSpec| matches!(behaviour, BehaviourSpec::Navigate(_));
    let is_served = has_robot(spec, |robot| {
        // A program may command robots without behaviours.
        let behaviours = &robot.brain.behaviours;
        behaviours.is_empty() || behaviours.iter().any(visits)
    });
    (kind.allocation == Allocation::None && !is_served).then(|| {
        let effect = "no goal is awarded, and no robot has the behaviour navigate to visit goals without an award";
        at.key("allocation").warning(effect.to_owned())
    })
}

fn of_maximum(kind: &ControllerSpec, at: &Place) -> Option<Warning> {
    (kind.max_goals == 0).then(|| {
        let effect = "these controllers refuse all goals";
        at.key("max_goals").warning(effect.to_owned())
    })
}

/// Searches that no robot can do: those that serve goals detect no items.
fn of_searches(spec: &ScenarioSpec, at: &Place) -> Vec<Warning> {
    let serves = |behaviour: &BehaviourSpec| matches!(behaviour, BehaviourSpec::Serve(_));
    let searches = has_robot(spec, |robot| {
        let mut sensors = robot.sensors.values();
        robot.brain.behaviours.iter().any(serves)
            && sensors.any(|sensor| sensor.provides(Provides::Items))
    });
    let has_servers = has_robot(spec, |robot| robot.brain.behaviours.iter().any(serves));
    let kinds = goals(spec).filter(|(_, kind)| kind.work == Work::Search);
    let kinds = kinds.filter(|_| has_servers && !searches);
    let found = kinds.map(|(name, _)| {
        let effect = "no robot with the behaviour serve has a detector of items";
        at.key("goals")
            .key(name)
            .key("work")
            .warning(effect.to_owned())
    });
    found.collect()
}

/// Whether there is a robot of a kind that meets a condition.
fn has_robot(spec: &ScenarioSpec, is_meant: impl Fn(&RobotSpec) -> bool) -> bool {
    let mut robots = spec.robots.values().filter(|robot| robot.count > 0);
    robots.any(is_meant)
}
