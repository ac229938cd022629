//! Brains in Python that replace those of a scenario's robot kinds, and its controllers.

use crate::arrays;
use crate::convert;
use crate::error::input_error;
use crate::message_check::{Kinds, tools_of};
use crate::metric_scenario::{name_of, participant_kind};
use base::document::path_of;
use base::error::InputErrors;
use brain::Command;
use pyo3::prelude::*;
use sim::scenario::Scenario;
use sim::step::{ExternalInputs, PendingDecision};

/// A Python brain for the robots or controllers of a kind.
#[derive(FromPyObject)]
pub(crate) struct PythonBrain<'py> {
    /// Name of the kind.
    kind: String,
    /// Whether `step` takes the percepts of all robots as arrays and returns their commands. Otherwise, it
    /// takes the index and the percept of one robot and returns its command.
    is_in_arrays: bool,
    step: Bound<'py, PyAny>,
}

impl PythonBrain<'_> {
    /// The index of its kind, if the scenario has that kind.
    pub(crate) fn kind(&self, scenario: &Scenario) -> Option<u8> {
        participant_kind(scenario, "brains", &self.kind).ok()
    }

    fn decide(&self, scenario: &Scenario, decisions: &mut [PendingDecision]) -> PyResult<()> {
        if self.is_in_arrays {
            let percepts = arrays::percepts(self.step.py(), decisions)?;
            let commands = self.step.call1((percepts,))?;
            let at = format!("{}()", path_of("brains", &self.kind));
            return arrays::command(&at, scenario, &commands, decisions);
        }
        decisions
            .iter_mut()
            .try_for_each(|decision| self.decide_for(scenario, decision))
    }

    fn decide_for(&self, scenario: &Scenario, decision: &mut PendingDecision) -> PyResult<()> {
        let percept = convert::write(self.step.py(), &decision.percept)?;
        let command = self.step.call1((decision.robot.index, percept))?;
        let parameter = parameter(scenario, decision.robot.kind);
        let at = path_of(parameter, &name_of(scenario, decision.robot));
        let at = format!("{at}.step()");
        let read = convert::read::<Command>(&at, &command);
        let tools = tools_of(scenario, decision.robot.kind);
        let read = read.and_then(|read| Kinds::of_scenario(scenario).command(&at, tools, read));
        decision.command = read.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        Ok(())
    }
}

/// The parameter that replaces the brains of a kind: those of controllers have their own.
fn parameter(scenario: &Scenario, kind: u8) -> &'static str {
    if usize::from(kind) < scenario.team().len() {
        "brains"
    } else {
        "controllers"
    }
}

/// Runs the Python brains of the robots and controllers that step, which sets their commands.
pub(crate) fn decide(
    scenario: &Scenario,
    brains: &[PythonBrain],
    inputs: &mut ExternalInputs,
) -> PyResult<()> {
    let robots = inputs.decisions();
    for decisions in robots.chunk_by_mut(|one, other| one.robot.kind == other.robot.kind) {
        let kind = decisions.first().map(|first| first.robot.kind);
        let mut matching = brains.iter().filter(|brain| brain.kind(scenario) == kind);
        if let Some(brain) = matching.next() {
            brain.decide(scenario, decisions)?;
        }
    }
    Ok(())
}
