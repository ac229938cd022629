//! Percepts and commands of external bodies, by robot name.

use crate::convert;
use crate::message_check::{Kinds, tools_of};
use crate::metric_scenario::{name_of, participant_of, robot_of};
use crate::percept_check::fitting;
use base::document::path_of;
use base::error::{InputError, InputErrors};
use brain::{AgentId, Command, Percept};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use sim::scenario::Scenario;
use sim::simulation::Simulation as Run;
use std::collections::{BTreeMap, BTreeSet};

/// A value for each of several robots or controllers.
pub(crate) type ByRobot<T> = BTreeMap<AgentId, T>;

/// Reads the percepts and commands of a step. The kinds in `in_python` have Python brains.
///
/// # Errors
/// The first error of each percept and command.
pub(crate) fn read(
    run: &Run,
    percepts: &Bound<PyDict>,
    commands: &Bound<PyDict>,
    in_python: &[u8],
) -> Result<(ByRobot<Percept>, ByRobot<Command>), InputErrors> {
    let mut errors = Vec::new();
    let scenario = run.scenario();
    let fits = |at: &str, id: AgentId, percept: Percept| match scenario.brain(id.kind) {
        Some(brain) => fitting(at, percept, brain.body()),
        None => Ok(percept),
    };
    let named = |name: &str| robot_of(scenario, "percepts", name);
    let percepts = by_robot(("percepts", percepts), named, fits, &mut errors);
    let kinds = Kinds::of_scenario(scenario);
    let allowed =
        |at: &str, id: AgentId, command| kinds.command(at, tools_of(scenario, id.kind), command);
    let named = |name: &str| participant_of(scenario, "commands", name);
    let commands = by_robot(("commands", commands), named, allowed, &mut errors);
    errors.extend(commands_of_external(run, &percepts, &commands));
    errors.extend(without_brain(scenario, &percepts, in_python));
    InputErrors::or(errors, Some((percepts, commands)))
}

fn by_robot<T: DeserializeOwned + JsonSchema>(
    (argument, given): (&str, &Bound<PyDict>),
    named: impl Fn(&str) -> Result<AgentId, InputError>,
    fits: impl Fn(&str, AgentId, T) -> Result<T, InputError>,
    errors: &mut Vec<InputError>,
) -> ByRobot<T> {
    let entry = |(name, given): (Bound<PyAny>, Bound<PyAny>)| {
        let name = convert::text(&name);
        let id = named(&name)?;
        let at = path_of(argument, &name);
        Ok((id, fits(&at, id, convert::read(&at, &given)?)?))
    };
    let entries = given.iter().map(entry);
    entries
        .filter_map(|read| read.map_err(|error| errors.push(error)).ok())
        .collect()
}

/// Rejects commands for external bodies: these return the commands of their own brains.
fn commands_of_external(
    run: &Run,
    percepts: &ByRobot<Percept>,
    commands: &ByRobot<Command>,
) -> Vec<InputError> {
    if commands.is_empty() {
        return Vec::new();
    }
    let robots = run.state().each_robot(run.scenario());
    let external = robots.filter(|robot| robot.is_external);
    let external: BTreeSet<AgentId> = external.map(|robot| robot.id).collect();
    let rejected = commands
        .keys()
        .filter(|id| external.contains(id) || percepts.contains_key(id));
    let error = |id: &AgentId| {
        let name = format!("{:?}", name_of(run.scenario(), *id));
        let allowed =
            "a robot without an external body: an external body takes no commands, it returns them";
        InputError::new("commands".to_owned(), Some(name), allowed.to_owned())
    };
    rejected.map(error).collect()
}

/// Percepts are only accepted for robots with the brain of the scenario.
fn without_brain(
    scenario: &Scenario,
    percepts: &ByRobot<Percept>,
    in_python: &[u8],
) -> impl Iterator<Item = InputError> {
    let given = percepts.keys().filter(|id| in_python.contains(&id.kind));
    given.map(|id| {
        let name = format!("{:?}", name_of(scenario, *id));
        let allowed =
            "a robot with the brain of the scenario: step the brains in `brains` yourself";
        InputError::new("percepts".to_owned(), Some(name), allowed.to_owned())
    })
}

/// Converts the values of several robots to a Python dict.
pub(crate) fn write<'py, T: serde::Serialize>(
    py: Python<'py>,
    scenario: &Scenario,
    values: &ByRobot<T>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (id, value) in values {
        dict.set_item(name_of(scenario, *id), convert::write(py, value)?)?;
    }
    Ok(dict)
}
