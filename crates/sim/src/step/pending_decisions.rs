//! Robots and controllers whose decisions are made elsewhere: what they perceive, and what is decided.

use crate::judge::detections::Detections;
use crate::run::agent::{Agent, Inputs};
use brain::{AgentId, Command, Percept};

/// A robot whose brain would step now, or a controller, whose decision is made elsewhere.
#[derive(Debug, Clone, Default)]
pub struct PendingDecision {
    /// The robot or controller.
    pub robot: AgentId,
    /// Its percept.
    pub percept: Percept,
    /// The decision; initially zero motion.
    pub command: Command,
    pub(super) number: usize,
    /// What waits for a robot after this percept.
    pub(super) inputs: Inputs,
}

/// All decisions of one step that are made elsewhere, and what the judge counts of these percepts.
#[derive(Debug, Clone, Default)]
pub(crate) struct PendingDecisions {
    /// In the order of their numbers: robots, then controllers.
    pub(crate) all: Vec<PendingDecision>,
    pub(crate) detections: Detections,
}

impl PendingDecisions {
    /// The decision for a robot or controller, by its number, if it was made elsewhere.
    pub(crate) fn decided(&self, number: usize) -> Option<&PendingDecision> {
        let place = self.all.binary_search_by_key(&number, |each| each.number);
        Some(&self.all[place.ok()?])
    }

    /// Removes from the inputs of these robots what their percepts contained.
    pub(crate) fn settle(&mut self, agents: &mut [Agent]) {
        for decision in &mut self.all {
            if let Some(agent) = agents.get_mut(decision.number) {
                agent.inputs = std::mem::take(&mut decision.inputs);
            }
        }
    }
}
