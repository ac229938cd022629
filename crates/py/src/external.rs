//! Percepts and commands of external bodies, by robot name.

use crate::convert;
use crate::message_check::{Kinds, tools_of};
use crate::metric_scenario::{name_of, participant_of, robot_of};
use crate::percept_check::fitting;
use base::document::path_of;
use base::error::{InputError, InputErrors};
use brain::{AgentId, Percept};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use sim::bodies::external::ExternalSpec;
use sim::scenario::Scenario;
use sim::simulation::{Simulation as Run, StepInputs};
use std::collections::{BTreeMap, BTreeSet};

/// A value for each of several robots or controllers.
pub(crate) type ByRobot<T> = BTreeMap<AgentId, T>;

/// Reads how the bodies of robots are external.
///
/// # Errors
/// The first error of each robot.
pub(crate) fn bodies(
    scenario: &Scenario,
    given: &Bound<PyDict>,
) -> Result<ByRobot<ExternalSpec>, InputErrors> {
    let mut errors = Vec::new();
    let named = |name: &str| robot_of(scenario, "external", name);
    let all = by_robot(
        ("external", given),
        named,
        |_, _, spec| Ok(spec),
        &mut errors,
    );
    for (id, spec) in &all {
        let at = path_of("external", &name_of(scenario, *id));
        errors.extend(scenario.errors_of_external(id.kind, spec, &at));
    }
    InputErrors::or(errors, Some(all))
}

/// Reads the inputs of a step: percepts, observed percepts and commands. The kinds in `in_python` have
/// Python brains.
///
/// # Errors
/// The first error of each percept and command.
pub(crate) fn read(
    run: &Run,
    [percepts, observed, commands]: &[Bound<PyDict>; 3],
    in_python: &[u8],
) -> Result<StepInputs, InputErrors> {
    let mut errors = Vec::new();
    let scenario = run.scenario();
    let fits = |at: &str, id: AgentId, percept: Percept| match scenario.brain(id.kind) {
        Some(brain) => fitting(at, percept, brain.body()),
        None => Ok(percept),
    };
    let mut perceived = |argument: &'static str, given: &Bound<PyDict>| {
        let named = |name: &str| robot_of(scenario, argument, name);
        by_robot((argument, given), named, fits, &mut errors)
    };
    let percepts = perceived("percepts", percepts);
    let observed = perceived("observed", observed);
    let kinds = Kinds::of_scenario(scenario);
    let allowed =
        |at: &str, id: AgentId, command| kinds.command(at, tools_of(scenario, id.kind), command);
    let named = |name: &str| participant_of(scenario, "commands", name);
    let commands = by_robot(("commands", commands), named, allowed, &mut errors);
    let inputs = StepInputs {
        percepts,
        observed,
        commands,
    };
    errors.extend(commands_of_external(run, &inputs));
    errors.extend(observed_twice(scenario, &inputs));
    errors.extend(without_brain(scenario, &inputs.percepts, in_python));
    InputErrors::or(errors, Some(inputs))
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
fn commands_of_external(run: &Run, inputs: &StepInputs) -> Vec<InputError> {
    let StepInputs {
        percepts,
        observed,
        commands,
    } = inputs;
    if commands.is_empty() {
        return Vec::new();
    }
    let robots = run.state().each_robot(run.scenario());
    let external = robots.filter(|robot| robot.is_external);
    let external: BTreeSet<AgentId> = external.map(|robot| robot.id).collect();
    let rejected = commands.keys().filter(|id| {
        external.contains(id)
            || [percepts, observed]
                .iter()
                .any(|given| given.contains_key(id))
    });
    let error = |id: &AgentId| {
        let name = format!("{:?}", name_of(run.scenario(), *id));
        let allowed =
            "a robot without an external body: an external body takes no commands, it returns them";
        InputError::new("commands".to_owned(), Some(name), allowed.to_owned())
    };
    rejected.map(error).collect()
}

/// Rejects a second percept of a robot.
fn observed_twice(scenario: &Scenario, inputs: &StepInputs) -> impl Iterator<Item = InputError> {
    let given = inputs.observed.keys();
    let given = given.filter(|id| inputs.percepts.contains_key(id));
    given.map(|id| {
        let name = format!("{:?}", name_of(scenario, *id));
        let allowed = "a robot that has no percept in `percepts`: its brain steps or does not";
        InputError::new("observed".to_owned(), Some(name), allowed.to_owned())
    })
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
