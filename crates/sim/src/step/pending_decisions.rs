//! Robots whose decisions are made outside their brains: what they perceive, and what is decided.

use crate::judge::detections::Detections;
use crate::run::agent::{Agent, Inputs};
use brain::{Command, Percept, RobotId};

/// A robot whose brain would step now, and whose decision is made elsewhere.
#[derive(Debug, Clone, Default)]
pub struct PendingDecision {
    /// The robot.
    pub robot: RobotId,
    /// The percept of its brain.
    pub percept: Percept,
    /// The decision; initially zero motion.
    pub command: Command,
    pub(super) number: usize,
    /// What waits for it after this percept.
    pub(super) inputs: Inputs,
}

/// All decisions of one step that are made elsewhere, and what the judge counts of these percepts.
#[derive(Debug, Clone, Default)]
pub(crate) struct PendingDecisions {
    /// In the order of the robots.
    pub(crate) robots: Vec<PendingDecision>,
    pub(crate) detections: Detections,
}

impl PendingDecisions {
    /// The decision for a robot, if it was made elsewhere.
    pub(crate) fn decided(&self, robot: usize) -> Option<&PendingDecision> {
        let place = self.robots.binary_search_by_key(&robot, |each| each.number);
        Some(&self.robots[place.ok()?])
    }

    /// Removes from the inputs of these robots what their percepts contained.
    pub(crate) fn settle(&mut self, agents: &mut [Agent]) {
        for robot in &mut self.robots {
            if let Some(agent) = agents.get_mut(robot.number) {
                agent.inputs = std::mem::take(&mut robot.inputs);
            }
        }
    }
}
