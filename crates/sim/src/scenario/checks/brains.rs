//! Checks that behaviours have what they need.

use super::ground::rectangle;
use crate::bodies::RobotSpec;
use crate::scenario::spec::ScenarioSpec;
use crate::sensors::KINDS;
use crate::sensors::sensor_kind::Provides;
use base::document::Place;
use base::error::InputError;
use base::geometry::{Point, Rectangle};
use brain::behaviours::BehaviourSpec;
use brain::{Arbitration, BrainSpec};
use std::collections::BTreeMap;

/// Maximum of `prior_count` for a kind of item.
const MAX_PRIOR_COUNT: f64 = 1e6;

/// Maximum `value` of a behaviour, and maximum gain.
const MAX_GAIN: f64 = 1e6;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let robots = spec.robots.iter();
    robots
        .flat_map(|(name, robot)| {
            let at = at.key("robots").key(name);
            let mut errors = of_behaviours(robot, spec, &at);
            errors.extend(of_wrapping(robot, spec, &at.key("brain")));
            errors.extend(of_gains(&robot.brain, &at.key("brain").key("arbitration")));
            errors.extend(of_beliefs(robot, spec, &at.key("brain").key("beliefs")));
            errors
        })
        .collect()
}

/// Behaviours that need sensors or a radio that the robot does not have.
fn of_behaviours(robot: &RobotSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let has = |what: Provides| {
        let mut sensors = robot.sensors.values();
        sensors.any(|sensor| sensor.provides(what))
    };
    let mut errors = Vec::new();
    for (number, behaviour) in robot.brain.behaviours.iter().enumerate() {
        let at = at.key("brain").key("behaviours").item(number);
        let name = behaviour.name();
        let mut needs = |is_needed: bool, what: Provides| {
            let example = KINDS.iter().find(|kind| kind.provides(what));
            if let Some(kind) = example.filter(|_| is_needed && !has(what)) {
                errors.push(at.key("kind").error(format!(
                    "a behaviour whose sensors the robot has: {name} needs, for example, {} under its sensors",
                    kind.example
                )));
            }
        };
        let needs_robots = match behaviour {
            BehaviourSpec::Flock(_) => true,
            BehaviourSpec::Follow(_) => robot.radio.is_none(),
            _ => false,
        };
        needs(needs_robots, Provides::Robots);
        needs(behaviour.needs_pose(), Provides::Position);
        needs(behaviour.needs_pose(), Provides::Heading);
        let needs_width = match behaviour {
            BehaviourSpec::Lawnmower(lanes) => lanes.width_m.is_none(),
            BehaviourSpec::Spiral(spiral) => spiral.width_m.is_none(),
            _ => false,
        };
        needs(behaviour.needs_detector() || needs_width, Provides::Items);
        if let BehaviourSpec::Navigate(navigate) = behaviour
            && navigate.is_shared_by_team()
            && robot.radio.is_none()
        {
            let allowed = "\"all\" or \"one_each\"; \"shared\" needs a radio, such as radio = { range_m = 100 }";
            errors.push(at.key("assignment").error(allowed));
        }
        if behaviour.serves_controllers() && robot.radio.is_none() {
            let allowed = "a behaviour that works without a radio: serve needs one, such as radio = { range_m = 100 }";
            errors.push(at.key("kind").error(allowed));
        }
        errors.extend(of_places(behaviour, spec, &at));
    }
    errors.extend(of_second_serve(robot, &at.key("brain").key("behaviours")));
    errors
}

/// A second behaviour that bids for the same goals as the first.
fn of_second_serve(robot: &RobotSpec, at: &Place) -> Vec<InputError> {
    let behaviours = robot.brain.behaviours.iter().enumerate();
    let serving = behaviours.filter(|(_, behaviour)| behaviour.serves_controllers());
    let more = serving.skip(1).map(|(number, behaviour)| {
        let allowed = format!("another behaviour: {} is listed before", behaviour.name());
        at.item(number).key("kind").error(allowed)
    });
    more.collect()
}

/// Waypoints that do not exist, or are outside the world.
fn of_places(behaviour: &BehaviourSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let way = |waypoints_m: &[Point]| {
        let numbered = waypoints_m.iter().enumerate();
        let listed = numbered.map(|(number, place)| (at.key("waypoints_m").item(number), *place));
        listed.collect()
    };
    let place =
        |key: &str, at_m: &Option<Point>| at_m.iter().map(|to| (at.key(key), *to)).collect();
    let places: Vec<(Place, Point)> = match behaviour {
        BehaviourSpec::Correct(correct) => way(&correct.waypoints_m),
        BehaviourSpec::Navigate(navigate) => way(&navigate.waypoints_m),
        BehaviourSpec::HoldPosition(hold) => place("at_m", &hold.at_m),
        BehaviourSpec::ReturnHome(home) => place("at_m", &home.at_m),
        BehaviourSpec::Spiral(spiral) => place("around_m", &spiral.around_m),
        _ => return Vec::new(),
    };
    let goes = match behaviour {
        // It can wait for a person's orders.
        BehaviourSpec::Correct(correct) => !correct.stop_when_done,
        BehaviourSpec::Navigate(_) => true,
        _ => false,
    };
    if goes && places.is_empty() {
        let allowed = "the places to visit, at least one, as in [[5, 5], [9, 2.5]]";
        return vec![at.key("waypoints_m").error(allowed)];
    }
    let (world, [width, height]) = (rectangle(&spec.world), spec.world.size_m);
    let allowed = format!(
        "within the world: from [0, 0] to [{}, {}]",
        width.0, height.0
    );
    let outside = places
        .into_iter()
        .filter(|(_, place)| !world.contains(*place));
    outside.map(|(at, _)| at.error(&allowed)).collect()
}

/// Gains of behaviours that the robot does not have, or that are not numbers.
fn of_gains(brain: &BrainSpec, at: &Place) -> Vec<InputError> {
    let Arbitration::Schemas(schemas) = &brain.arbitration else {
        return Vec::new();
    };
    let kinds: Vec<&str> = brain.behaviours.iter().map(BehaviourSpec::name).collect();
    of_numbers(&schemas.gains, MAX_GAIN, &kinds, &at.key("gains"))
}

/// Numbers under keys that are none of the `known`, or not from 0 to `max`.
fn of_numbers(
    numbers: &BTreeMap<String, f64>,
    max: f64,
    known: &[&str],
    at: &Place,
) -> Vec<InputError> {
    let error = |(key, number): (&String, &f64)| {
        let at = at.key(key);
        if !known.contains(&key.as_str()) {
            return Some(at.unknown_key(key, known.iter().copied()));
        }
        (!(0.0..=max).contains(number)).then(|| at.error(format!("a number from 0 to {max}")))
    };
    numbers.iter().filter_map(error).collect()
}

/// Maps in a periodic world: beliefs draw maps, which end.
fn of_wrapping(robot: &RobotSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    if !spec.world.periodic {
        return Vec::new();
    }
    let behaviours = robot.brain.behaviours.iter().enumerate();
    let minded = behaviours.filter(|(_, behaviour)| behaviour.needs_beliefs());
    let at_behaviours = minded.map(|(number, behaviour)| {
        let at = at.key("behaviours").item(number).key("kind");
        at.error(format!(
            "a behaviour that needs no map in a periodic world: {} needs periodic = false",
            behaviour.name()
        ))
    });
    let beliefs = robot.brain.beliefs.iter().map(|_| {
        at.key("beliefs")
            .error("omitted in a periodic world: maps need periodic = false")
    });
    at_behaviours.chain(beliefs).collect()
}

/// Priors for kinds of items that do not exist.
fn of_beliefs(robot: &RobotSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let Some(beliefs) = &robot.brain.beliefs else {
        return Vec::new();
    };
    let kinds: Vec<&str> = spec.items.keys().map(String::as_str).collect();
    let at_priors = at.key("prior_count");
    let mut errors = of_numbers(&beliefs.prior_count, MAX_PRIOR_COUNT, &kinds, &at_priors);
    let ([width, height], world) = (spec.world.size_m, rectangle(&spec.world));
    let is_in_it = |area: &Rectangle| {
        world.contains(area.min()) && world.contains(area.max()) && area.area_m2() > 0.0
    };
    if beliefs.area_m.as_ref().is_some_and(|area| !is_in_it(area)) {
        let allowed = format!(
            "two opposite corners within [0, 0] and [{}, {}]",
            width.0, height.0
        );
        errors.push(at.key("area_m").error(allowed));
    }
    errors
}
