//! What comes into a run from outside and goes there, by robots' names: KIND/INDEX.

use crate::convert;
use crate::metric_scenario::{name_of, robot_of};
use crate::percept_check::fitting;
use base::document::path_of;
use base::error::{InputError, InputErrors};
use brain::{Command, Percept, RobotId};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use sim::scenario::Scenario;
use sim::simulation::Simulation as Run;
use std::collections::{BTreeMap, BTreeSet};

/// Something for each of some robots.
pub(crate) type ByRobot<T> = BTreeMap<RobotId, T>;

/// The percepts and commands of a step; the brains of some kinds are `elsewhere`.
///
/// # Errors
/// Everything that is wrong with them; of each percept and command the first error.
pub(crate) fn read(
    run: &Run,
    percepts: &Bound<PyDict>,
    commands: &Bound<PyDict>,
    elsewhere: &[u8],
) -> Result<(ByRobot<Percept>, ByRobot<Command>), InputErrors> {
    let mut errors = Vec::new();
    let scenario = run.scenario();
    let fits = |at: &str, id: RobotId, percept: Percept| match scenario.brain(id.kind) {
        Some(brain) => fitting(at, percept, brain.body()),
        None => Ok(percept),
    };
    let percepts = by_robot(scenario, ("percepts", percepts), fits, &mut errors);
    let as_it_is = |_: &str, _, command| Ok(command);
    let commands = by_robot(scenario, ("commands", commands), as_it_is, &mut errors);
    errors.extend(commanded_outside(run, &percepts, &commands));
    errors.extend(without_brain(scenario, &percepts, elsewhere));
    InputErrors::or(errors, Some((percepts, commands)))
}

fn by_robot<T: DeserializeOwned + JsonSchema>(
    scenario: &Scenario,
    (argument, given): (&str, &Bound<PyDict>),
    fits: impl Fn(&str, RobotId, T) -> Result<T, InputError>,
    errors: &mut Vec<InputError>,
) -> ByRobot<T> {
    let entry = |(name, given): (Bound<PyAny>, Bound<PyAny>)| {
        let name = convert::text(&name);
        let id = robot_of(scenario, argument, &name)?;
        let at = path_of(argument, &name);
        Ok((id, fits(&at, id, convert::read(&at, &given)?)?))
    };
    let entries = given.iter().map(entry);
    entries
        .filter_map(|read| read.map_err(|error| errors.push(error)).ok())
        .collect()
}

/// A body outside obeys its own brain: its command is handed out, and none goes in.
fn commanded_outside(
    run: &Run,
    percepts: &ByRobot<Percept>,
    commands: &ByRobot<Command>,
) -> Vec<InputError> {
    if commands.is_empty() {
        return Vec::new();
    }
    let robots = run.state().each_robot(run.scenario());
    let outside = robots.filter(|robot| robot.is_external);
    let outside: BTreeSet<RobotId> = outside.map(|robot| robot.id).collect();
    let of_outside = commands
        .keys()
        .filter(|id| outside.contains(id) || percepts.contains_key(id));
    let error = |id: &RobotId| {
        let name = format!("{:?}", name_of(run.scenario(), *id));
        let allowed = "a robot whose body is not outside: it gives percepts, and gets commands";
        InputError::new("commands".to_owned(), Some(name), allowed.to_owned())
    };
    of_outside.map(error).collect()
}

/// Only the brain of a scenario steps with percepts from outside.
fn without_brain(
    scenario: &Scenario,
    percepts: &ByRobot<Percept>,
    elsewhere: &[u8],
) -> impl Iterator<Item = InputError> {
    let given = percepts.keys().filter(|id| elsewhere.contains(&id.kind));
    given.map(|id| {
        let name = format!("{:?}", name_of(scenario, *id));
        let allowed = "a robot that has the scenario's brain: step yours of `brains` yourself";
        InputError::new("percepts".to_owned(), Some(name), allowed.to_owned())
    })
}

/// Something for each of some robots, as Python has it.
pub(crate) fn write<'py, T: serde::Serialize>(
    py: Python<'py>,
    scenario: &Scenario,
    told: &ByRobot<T>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (id, told) in told {
        dict.set_item(name_of(scenario, *id), convert::write(py, told)?)?;
    }
    Ok(dict)
}
