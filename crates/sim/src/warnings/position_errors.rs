//! Warnings about waypoints and goals whose tolerance is smaller than the errors of positions allow.

use crate::bodies::RobotSpec;
use crate::scenario::{Checked, ScenarioSpec};
use crate::sensors::position::PositionSpec;
use crate::sensors::sensor_kind::AmongKinds;
use base::document::Place;
use base::warning::Warning;
use brain::behaviours::BehaviourSpec;
use brain::max_deviation_m;

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    let robots = spec.robots.iter().filter(|(_, robot)| robot.count > 0);
    let of_robots =
        robots.flat_map(|(name, robot)| of_waypoints(robot, &at.key("robots").key(name)));
    of_robots.chain(of_goals(spec, at)).collect()
}

/// The waypoints of a robot's behaviours.
fn of_waypoints(robot: &RobotSpec, at: &Place) -> Vec<Warning> {
    let Some(errors) = Errors::of(robot) else {
        return Vec::new();
    };
    let at = at.key("brain").key("behaviours");
    let behaviours = robot.brain.behaviours.iter().enumerate();
    let found = behaviours.filter_map(|(number, behaviour)| {
        let effect = errors.effect(behaviour.within_m()?)?;
        Some(at.item(number).key("within_m").warning(effect))
    });
    found.collect()
}

/// The goals that controllers award to robots, if none of these robots knows its position well enough.
fn of_goals(spec: &ScenarioSpec, at: &Place) -> Vec<Warning> {
    let serves = |robot: &&RobotSpec| {
        let mut behaviours = robot.brain.behaviours.iter();
        robot.count > 0 && behaviours.any(BehaviourSpec::serves_controllers)
    };
    let robots = spec.robots.values().filter(serves);
    let errors: Option<Vec<Errors>> = robots.map(Errors::of).collect();
    let errors = errors.unwrap_or_default().into_iter();
    let Some(errors) = errors.min_by(|one, other| one.total_m().total_cmp(&other.total_m())) else {
        return Vec::new();
    };
    let goals = spec.goals.iter().filter(|(_, goal)| goal.count > 0);
    let found = goals.filter_map(|(name, goal)| {
        let effect = errors.effect(goal.within_m)?;
        Some(at.key("goals").key(name).key("within_m").warning(effect))
    });
    found.collect()
}

/// The errors of the position sensor of a robot.
#[derive(Clone, Copy)]
struct Errors {
    noise_m: f64,
    drift_m: f64,
}

impl Errors {
    /// `None` without a position sensor.
    fn of(robot: &RobotSpec) -> Option<Self> {
        let sensors = robot.sensors.values();
        let positions = sensors.filter_map(|sensor| PositionSpec::of(&sensor.measures));
        let positions = positions.map(|position| Self {
            noise_m: position.noise_m,
            drift_m: position.drift_m,
        });
        positions.reduce(|one, other| Self {
            noise_m: one.noise_m.max(other.noise_m),
            drift_m: one.drift_m.max(other.drift_m),
        })
    }

    fn total_m(&self) -> f64 {
        self.noise_m.hypot(self.drift_m)
    }

    /// The effect on places that are to be reached within a distance, if there is one.
    fn effect(&self, within_m: f64) -> Option<String> {
        let min_m = 2.0 * self.total_m();
        if self.drift_m > max_deviation_m(within_m) {
            let drift_m = self.drift_m;
            Some(format!(
                "{within_m} m is less than twice the drift of the position sensor, {drift_m} m: the position is \
                 never known well enough, and each such place is impossible; set at least {min_m:.3} m"
            ))
        } else if self.total_m() > max_deviation_m(within_m) {
            let total_m = self.total_m();
            Some(format!(
                "{within_m} m is less than twice the error of the position sensor, {total_m:.3} m: the robot waits at \
                 the place until it knows its position well enough, and gives up after 30 s; set at least \
                 {min_m:.3} m"
            ))
        } else {
            None
        }
    }
}
