//! Brains in Python that replace those of a scenario's robot kinds.

use crate::arrays;
use crate::commands::Commands;
use crate::convert;
use crate::error::input_error;
use crate::metric_scenario::{kind_of, name_of};
use base::document::path_of;
use base::error::InputErrors;
use brain::Command;
use pyo3::prelude::*;
use sim::scenario::Scenario;
use sim::step::{ExternalInputs, PendingDecision};

/// A Python brain for the robots of a kind.
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
        kind_of(scenario, "brains", &self.kind).ok()
    }

    fn decide(&self, scenario: &Scenario, asked: &mut [PendingDecision]) -> PyResult<()> {
        if self.is_in_arrays {
            let percepts = arrays::percepts(self.step.py(), asked)?;
            let commands: Commands = self.step.call1((percepts,))?.extract()?;
            commands.give(asked);
            return Ok(());
        }
        asked
            .iter_mut()
            .try_for_each(|asked| self.decide_for(scenario, asked))
    }

    fn decide_for(&self, scenario: &Scenario, asked: &mut PendingDecision) -> PyResult<()> {
        let percept = convert::write(self.step.py(), &asked.percept)?;
        let command = self.step.call1((asked.robot.index, percept))?;
        let at = path_of("brains", &name_of(scenario, asked.robot));
        let read = convert::read::<Command>(&format!("{at}.step()"), &command);
        asked.command = read.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        Ok(())
    }
}

/// Asks brains in Python what the robots of a step are to do.
pub(crate) fn decide(
    scenario: &Scenario,
    brains: &[PythonBrain],
    outside: &mut ExternalInputs,
) -> PyResult<()> {
    let robots = outside.decisions();
    for asked in robots.chunk_by_mut(|one, other| one.robot.kind == other.robot.kind) {
        let kind = asked.first().map(|first| first.robot.kind);
        let mut of_kind = brains.iter().filter(|brain| brain.kind(scenario) == kind);
        if let Some(brain) = of_kind.next() {
            brain.decide(scenario, asked)?;
        }
    }
    Ok(())
}
