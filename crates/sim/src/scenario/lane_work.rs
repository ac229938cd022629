//! Whether sensors and tools of ground robots reach mines from where these cannot destroy them.

use super::spec::ScenarioSpec;
use crate::bodies::{Layer, RobotSpec};
use crate::controllers::clearance::{ClearanceSpec, SkillSpec};
use crate::controllers::lane::detectors;
use crate::sensors::position::PositionSpec;
use crate::sensors::sensor_kind::AmongKinds;
use brain::behaviours::BehaviourSpec;
use brain::min_work_range_m;

/// Standard deviations of a position that a range has to allow for.
const DEVIATIONS: f64 = 3.0;

/// A sensor or tool of a kind of robots, and the ranges that it needs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WorkReach<'s> {
    pub(crate) robot: &'s str,
    /// Its keys below the robot.
    pub(crate) keys: [&'s str; 2],
    pub(crate) range_m: f64,
    /// The most dangerous item, and the distance at which it is a danger to a robot of a radius.
    pub(crate) item: &'s str,
    pub(crate) danger_m: f64,
    pub(crate) radius_m: f64,
    /// With this range or less, it reaches no item.
    pub(crate) min_m: f64,
    /// With less than this range, it may not reach one, as positions have errors.
    pub(crate) safe_m: f64,
}

/// The sensors and tools with which ground robots interrogate and neutralise.
pub(crate) fn reaches<'s>(
    clearance: &'s ClearanceSpec,
    spec: &'s ScenarioSpec,
) -> Vec<WorkReach<'s>> {
    let robots = spec.robots.iter();
    let robots = robots.filter(|(_, robot)| robot.layer == Layer::Ground && serves(robot));
    let reaches = robots.flat_map(|(name, robot)| of_robot((name, robot), clearance, spec));
    reaches.collect()
}

fn of_robot<'s>(
    (name, robot): (&'s str, &'s RobotSpec),
    clearance: &ClearanceSpec,
    spec: &'s ScenarioSpec,
) -> Vec<WorkReach<'s>> {
    let Some((item, danger_m)) = worst_hazard(spec) else {
        return Vec::new();
    };
    let min_m = min_work_range_m(danger_m, robot.radius_m);
    let noises = detectors(robot).map(|(_, items, _)| items.noise_m);
    let noise_m = noises.fold(0.0, f64::max);
    let reach = |keys, range_m, deviation_m: f64| WorkReach {
        robot: name,
        keys,
        range_m,
        item,
        danger_m,
        radius_m: robot.radius_m,
        min_m,
        safe_m: min_m + DEVIATIONS * deviation_m,
    };
    let mut reaches = Vec::new();
    if has(robot, clearance.interrogate.as_ref()) {
        // A mark has the position of another robot.
        let deviation_m = libm::hypot(noise_m, position_noise_m(robot));
        reaches.extend(detectors(robot).map(|(sensor, items, _)| {
            let keys = ["sensors", sensor.as_str()];
            reach(keys, items.sector.range_m, deviation_m)
        }));
    }
    let charge = robot.tools.neutralise.as_ref();
    let charge = charge.filter(|_| has(robot, clearance.neutralise.as_ref()));
    reaches.extend(charge.map(|tool| reach(["tools", "neutralise"], tool.range_m, noise_m)));
    let fence = robot.tools.isolate.as_ref();
    let fence = fence.filter(|_| has(robot, clearance.interrogate.as_ref()));
    reaches.extend(fence.map(|tool| reach(["tools", "isolate"], tool.range_m, noise_m)));
    reaches
}

/// The kind of items that destroys robots from the largest distance.
fn worst_hazard(spec: &ScenarioSpec) -> Option<(&str, f64)> {
    let items = spec.items.iter();
    let dangers = items.filter_map(|(name, kind)| {
        let hazard = kind
            .hazard
            .filter(|hazard| hazard.destroy_probability > 0.0)?;
        Some((name.as_str(), hazard.radius_m))
    });
    dangers.max_by(|one, other| one.1.total_cmp(&other.1))
}

fn serves(robot: &RobotSpec) -> bool {
    let mut behaviours = robot.brain.behaviours.iter();
    behaviours.any(|behaviour| matches!(behaviour, BehaviourSpec::Serve(_)))
}

/// Whether a robot has what goals of a kind need, if there are any.
fn has(robot: &RobotSpec, skill: Option<&SkillSpec>) -> bool {
    skill.is_some_and(|skill| {
        let mut required = skill.requires.iter();
        required.all(|name| robot.capabilities.contains(name))
    })
}

fn position_noise_m(robot: &RobotSpec) -> f64 {
    let sensors = robot.sensors.values();
    let noises = sensors.filter_map(|sensor| Some(PositionSpec::of(&sensor.measures)?.noise_m));
    noises.fold(0.0, f64::max)
}
