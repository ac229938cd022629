//! What comes from outside in a step: percepts of bodies that are not simulated, and commands that
//! stand for what a brain would decide.

use brain::{Command, Percept};
use std::collections::BTreeMap;

/// Percepts and commands from outside, by the robot's number.
#[derive(Debug, Clone, Default)]
pub(crate) struct Outside {
    pub(crate) percepts: BTreeMap<usize, Percept>,
    pub(crate) commands: BTreeMap<usize, Command>,
}

impl Outside {
    pub(crate) fn is_empty(&self) -> bool {
        self.percepts.is_empty() && self.commands.is_empty()
    }
}
