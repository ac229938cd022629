//! Checks of lanes that controllers are to clear.

use super::controllers::unknown;
use super::lane_outcomes;
use crate::bodies::{Layer, RobotSpec};
use crate::controllers::clearance::{ClearanceSpec, SkillSpec};
use crate::controllers::lane::{detectors, in_truth};
use crate::scenario::lane_work;
use crate::scenario::spec::ScenarioSpec;
use crate::world::items::CompletedBy;
use base::document::{Document, Place, Value};
use base::error::InputError;
use brain::MARK_KINDS;
use brain::behaviours::BehaviourSpec;
use std::collections::{BTreeMap, BTreeSet};

/// The lowest risk of declarations is above the floor by this factor, so that robots can reach it.
const ABOVE_FLOOR: f64 = 1.05;

/// The share of missions that a requirement without one has.
const DEFAULT_PROBABILITY: f64 = 0.95;

pub(super) fn errors(spec: &ScenarioSpec, document: &Document) -> Vec<InputError> {
    let at = &document.place();
    let all = at.key("controllers");
    let with_lane = spec.controllers.iter();
    let with_lane = with_lane.filter_map(|(name, kind)| Some((name, kind.clearance.as_ref()?)));
    let mut errors = Vec::new();
    for (number, (name, clearance)) in with_lane.enumerate() {
        let root = at;
        let at = all.key(name).key("clearance");
        if number > 0 {
            let allowed = "omitted: another kind of controllers has a lane already";
            errors.push(at.error(allowed));
        } else {
            errors.extend(of_world(spec, root));
        }
        errors.extend(of_lane(clearance, spec, &at));
        errors.extend(of_expected(clearance, spec, &at));
        errors.extend(of_skills(clearance, spec, &at));
        errors.extend(of_leases(name, clearance, spec, &all));
        errors.extend(of_floor(clearance, spec, &at));
        errors.extend(of_requirement(clearance, spec, document));
        errors.extend(of_view(clearance, spec, &at));
        errors.extend(of_work(clearance, spec, root));
    }
    errors
}

/// A lane that is not in the world, has too many cells, or is narrower than the vehicles.
fn of_lane(clearance: &ClearanceSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let cells = at.key("cell_m");
    let at = at.key("lane_m");
    let [width, height] = spec.world.size_m;
    if let Some([min, max]) = clearance.lane_m {
        let is_in = |low: f64, high: f64, size_m: f64| 0.0 <= low && low < high && high <= size_m;
        if !is_in(min[0], max[0], width.0) || !is_in(min[1], max[1], height.0) {
            let allowed = format!(
                "the lower left and the upper right corner of a lane in the world, from [0, 0] to [{}, {}]",
                width.0, height.0
            );
            return vec![at.error(allowed)];
        }
    }
    let size = clearance.area(spec).size();
    let narrow_m = size.x.min(size.y);
    let vehicles = spec.robots.iter();
    let vehicles = vehicles.filter(|(_, robot)| robot.layer == Layer::Ground);
    let wide = vehicles.filter(|(_, robot)| 2.0 * robot.radius_m > narrow_m);
    let mut errors: Vec<InputError> = wide
        .map(|(name, robot)| {
            at.error(format!(
                "a lane at least as wide as robots.{name}, {} m",
                2.0 * robot.radius_m
            ))
        })
        .collect();
    if !clearance.ready(spec).lane.is_valid() {
        let allowed = "larger, so that the lane has at most 65536 cells";
        errors.push(cells.error(allowed));
    }
    errors
}

/// Kinds of items that do not exist, too many of them, and impossible numbers.
fn of_expected(clearance: &ClearanceSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let at = at.key("expected_count");
    let mut errors = Vec::new();
    for (kind, expected) in &clearance.expected_count {
        if !spec.items.contains_key(kind) {
            errors.push(unknown(kind, spec.items.keys(), &at.key(kind)));
        } else if !(0.0..=1e6).contains(expected) {
            errors.push(at.key(kind).error("a number from 0 to 1000000"));
        }
    }
    errors
}

/// Skills that no robots have.
fn of_skills(clearance: &ClearanceSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    let can_serve = |robot: &&RobotSpec| {
        let mut behaviours = robot.brain.behaviours.iter();
        let is_served = behaviours.any(|behaviour| matches!(behaviour, BehaviourSpec::Serve(_)));
        robot.radio.is_some() && is_served
    };
    let servers: Vec<&RobotSpec> = spec.robots.values().filter(can_serve).collect();
    let known = servers.iter().flat_map(|robot| &robot.capabilities);
    let known: BTreeSet<&String> = known.collect();
    let mut check = |skill: &SkillSpec, at: &Place| {
        if let Some(required) = skill.requires.as_ref().filter(|name| !known.contains(name)) {
            let at = at.key("requires");
            errors.push(unknown(required, known.iter().copied(), &at));
        }
    };
    for (number, skill) in clearance.searches.iter().enumerate() {
        check(skill, &at.key("searches").item(number));
    }
    let single = [
        ("interrogate", &clearance.interrogate),
        ("neutralise", &clearance.neutralise),
    ];
    for (key, skill) in single {
        if let Some(skill) = skill {
            check(skill, &at.key(key));
        }
    }
    let mut tools = servers.iter().map(|robot| &robot.tools.neutralise);
    if clearance.neutralise.is_some() && !tools.any(Option::is_some) {
        let allowed = "omitted, unless robots with the behaviour \"serve\" have tools.neutralise";
        errors.push(at.key("neutralise").error(allowed));
    }
    if clearance.searches.is_empty() {
        errors.push(at.key("searches").error("at least one way to search"));
    }
    errors
}

/// A lease that ends before a goal of the lane is served.
fn of_leases(
    name: &str,
    clearance: &ClearanceSpec,
    spec: &ScenarioSpec,
    all: &Place,
) -> Option<InputError> {
    let kind = spec.controllers.get(name)?;
    let looks = clearance.searches.iter();
    let looks = looks
        .chain(&clearance.interrogate)
        .chain(&clearance.neutralise);
    let longest_s = looks.map(|skill| skill.service_s).fold(0.0, f64::max);
    let tools = spec.robots.values();
    let tools = tools.filter_map(|robot| robot.tools.neutralise.as_ref());
    let charge_s = tools.map(|tool| tool.duration_s).fold(0.0, f64::max);
    let [trip_s, _] = super::controllers::round_trips_s(kind, spec);
    let min_lease_s = (1.0 + spec.clock.max_drift) * (longest_s + charge_s + trip_s);
    let allowed = format!(
        "at least {min_lease_s:.3}: it must outlast the longest look at a place, {longest_s} s, a charge, {charge_s} s, and \
         a round trip of {trip_s:.3} s over the radio"
    );
    let at = all.key(name).key("service_lease_s");
    (kind.service_lease_s < min_lease_s)
        .then(|| super::controllers::of_lease(kind.service_lease_s, allowed, &at))
}

/// A risk that no number of looks reaches.
fn of_floor(clearance: &ClearanceSpec, spec: &ScenarioSpec, at: &Place) -> Option<InputError> {
    let floor = clearance.ready(spec).floor();
    let allowed = format!(
        "at least {:.4}: the sensors are blind to some mines, and the risk never falls below {floor:.4}",
        floor * ABOVE_FLOOR
    );
    let at = at.key("declare_below");
    (clearance.declare_below < floor * ABOVE_FLOOR)
        .then(|| super::controllers::of_lease(clearance.declare_below, allowed, &at))
}

/// A requirement that more lanes are declared clear, and are clear, than any number of looks achieves.
fn of_requirement(
    clearance: &ClearanceSpec,
    spec: &ScenarioSpec,
    document: &Document,
) -> Option<InputError> {
    let conditions = document.get(&["require", "all"]).map(|node| &node.value);
    let Some(Value::List(conditions)) = conditions else {
        return None;
    };
    if !lane_outcomes::need_clear(conditions, spec) {
        return None;
    }
    let place = document.place().key("require");
    let written = place.key("probability").value();
    let required = written.map_or(Some(DEFAULT_PROBABILITY), |text| text.parse().ok())?;
    let believed = clearance.ready(spec);
    let floor = in_truth(&believed, spec).unwrap_or(believed).floor();
    let allowed = format!(
        "at most {:.3}: with probability {floor:.3}, a mine remains that no sensor detects, and the lane is not clear",
        1.0 - floor
    );
    (required > 1.0 - floor).then(|| place.key("probability").error(allowed))
}

/// Cells that are larger than what a detector sees: a cell counts as searched by looks at few of its places.
fn of_view(clearance: &ClearanceSpec, spec: &ScenarioSpec, at: &Place) -> Option<InputError> {
    let robots = spec.robots.iter();
    let views = robots.flat_map(|(name, robot)| {
        let of_robot = move |(sensor, items, _): (_, &crate::sensors::items::ItemsSpec, _)| {
            (items.sector.range_m, name, sensor)
        };
        detectors(robot).map(of_robot)
    });
    let (range_m, robot, sensor) = views.min_by(|one, other| one.0.total_cmp(&other.0))?;
    let at = at.key("cell_m");
    let allowed = format!(
        "at most {range_m}: robots.{robot}.sensors.{sensor} sees no farther than {range_m} m, and a cell counts as searched \
         by looks at four of its places"
    );
    (clearance.cell_m > range_m)
        .then(|| super::controllers::of_lease(clearance.cell_m, allowed, &at))
}

/// Sensors and tools that reach no mine from where it cannot destroy the robot.
fn of_work(clearance: &ClearanceSpec, spec: &ScenarioSpec, root: &Place) -> Vec<InputError> {
    let reaches = lane_work::reaches(clearance, spec);
    let errors = reaches.iter().filter(|reach| reach.range_m <= reach.min_m);
    let errors = errors.map(|reach| {
        let at = root.key("robots").key(reach.robot);
        let at = reach.keys.iter().fold(at, |at, key| at.key(key));
        at.key("range_m").error(format!(
            "above {:.3}: from farther away only, {}, which is a danger within {} m, cannot destroy the robot, which has a \
             radius of {} m",
            reach.min_m, reach.item, reach.danger_m, reach.radius_m
        ))
    });
    errors.collect()
}

/// Worlds, items and sensors with which a lane cannot be cleared.
fn of_world(spec: &ScenarioSpec, root: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    if spec.world.periodic {
        let allowed = "false: controllers clear lanes only in worlds with a border";
        errors.push(root.key("world").key("periodic").error(allowed));
    }
    let items = root.key("items");
    if spec.items.len() > MARK_KINDS {
        let allowed = format!("at most {MARK_KINDS} kinds: marks distinguish no more");
        errors.push(items.error(allowed));
    }
    let targets = spec.items.iter().filter(|(_, kind)| kind.target);
    if targets.clone().next().is_none() {
        errors.push(items.error("with at least one kind of targets, the mines"));
    }
    let incomplete = targets.filter(|(_, kind)| kind.completed_by != CompletedBy::Neutralised);
    errors.extend(incomplete.map(|(name, _)| {
        let allowed = "\"neutralised\": until then, targets make the lane unsafe";
        items.key(name).key("completed_by").error(allowed)
    }));
    for (name, robot) in &spec.robots {
        let models = detectors(robot).map(|(sensor, items, _)| items.model_name(name, sensor));
        let models: BTreeSet<String> = models.collect();
        let is_blind = |(_, items, _): (_, &crate::sensors::items::ItemsSpec, _)| {
            let believed = items.as_believed(spec.items.keys());
            let alike = believed.lookalike_share.values().flat_map(BTreeMap::values);
            let mut shares = believed.blind_share.values().chain(alike);
            shares.any(|share| *share > 0.0)
        };
        if models.len() > 1 && detectors(robot).any(is_blind) {
            let allowed = "item detectors of one model: robots report all of their looks together";
            errors.push(root.key("robots").key(name).key("sensors").error(allowed));
        }
    }
    errors.extend(of_models(spec, root));
    errors
}

/// Sensors of one model to which different items are believed to look alike: controllers know one table of each model.
fn of_models(spec: &ScenarioSpec, root: &Place) -> Vec<InputError> {
    let mut models = BTreeMap::new();
    let mut errors = Vec::new();
    for (name, robot) in &spec.robots {
        for (sensor, items, _) in detectors(robot) {
            let believed = items.as_believed(spec.items.keys()).lookalike_share.clone();
            let path = format!("robots.{name}.sensors.{sensor}");
            let (first, known) = models
                .entry(items.model_name(name, sensor))
                .or_insert_with(|| (path, believed.clone()));
            if *known != believed {
                let at = root.key("robots").key(name).key("sensors").key(sensor);
                let allowed = format!(
                    "as in {first}, which is of the same model, or a model of another name"
                );
                errors.push(at.key("lookalike_share").error(allowed));
            }
        }
    }
    errors
}
