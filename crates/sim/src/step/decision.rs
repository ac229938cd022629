//! What decides for a robot in a step; chosen before the robot senses.

use super::external::ExternalInputs;
use super::flocks::Flocks;
use super::pending_decisions::PendingDecision;
use super::view::View;
use crate::bodies::body_state::Status;
use brain::{Command, Percept};

/// What all robots decide from in one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DecisionInputs<'a> {
    pub(crate) view: &'a View<'a>,
    pub(crate) external: Option<&'a ExternalInputs>,
    pub(crate) flocks: &'a Flocks,
    pub(crate) hashes_decisions: bool,
}

/// What decides for a robot.
#[derive(Debug, Clone, Copy)]
pub(super) enum Decision<'a> {
    /// Its brain, if it steps now.
    Brain,
    /// Its brain, from a percept from outside of the simulation and what its virtual sensors add.
    BrainOf(&'a Percept),
    /// A command that was given for this step. Its brain does not step.
    Command(&'a Command),
    /// Another program, from the percept that it got.
    Elsewhere(&'a PendingDecision),
    /// Nothing: an external body without a percept.
    Nothing,
    /// Nothing: a robot that cannot move any more.
    Still,
}

impl<'a> DecisionInputs<'a> {
    /// What decides for a robot.
    #[inline]
    pub(super) fn decision(&self, robot: usize) -> Decision<'a> {
        let body_state = &self.view.body_states[robot];
        if body_state.status != Status::Active {
            return Decision::Still;
        }
        if self.external.is_none() && !self.view.has_external_bodies {
            return Decision::Brain;
        }
        let from_outside = self.external.and_then(|external| {
            let decided = external.decisions.decided(robot);
            let percept = external.percepts.get(&robot);
            let command = external.commands.get(&robot);
            let command = command.filter(|_| !body_state.is_external());
            decided
                .map(Decision::Elsewhere)
                .or_else(|| percept.map(Decision::BrainOf))
                .or_else(|| command.map(Decision::Command))
        });
        from_outside.unwrap_or(if body_state.is_external() {
            Decision::Nothing
        } else {
            Decision::Brain
        })
    }
}
