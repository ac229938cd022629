//! The robot that is inspected, and what its brain had before its last step.

use brain::{AgentId, Brain, Percept};

/// The inspected robot, and what its brain had before its last step.
#[derive(Debug, Clone, Default)]
pub(super) struct Probe {
    pub(super) robot: Option<AgentId>,
    pub(super) last: Option<Box<Last>>,
}

#[derive(Debug, Clone)]
pub(super) struct Last {
    pub(super) tick: u64,
    pub(super) percept: Percept,
    pub(super) brain: Brain,
}

impl Probe {
    /// Drops the recorded decision: it belongs to another moment.
    pub(super) fn forget(&mut self) {
        self.last = None;
    }
}
