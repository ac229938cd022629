//! Inspection of a robot: what its brain perceives, decides, and why.
//!
//! Inspection does not change the run: a copy of the brain from before its last step is kept, and
//! takes that step again when its decision is requested.

use super::Simulation;
use super::probe::{Last, Probe};
use crate::bodies::body_state::Status;
use brain::{AgentId, Decision, Percept};

/// A percept of a robot, and the decision of its brain.
#[derive(Debug, Clone, PartialEq)]
pub struct Inspected {
    /// The robot.
    pub robot: AgentId,
    /// Number of the step in which it decided.
    pub tick: u64,
    /// The percept.
    pub percept: Percept,
    /// The decision, and its reasons.
    pub decision: Decision,
}

impl Simulation {
    /// Inspects a robot from now on, or none. Nothing in the run changes. A change of scenario ends the
    /// inspection, because it renumbers robots.
    pub fn inspect(&mut self, robot: Option<AgentId>) {
        if self.probe.robot != robot {
            self.probe = Probe { robot, last: None };
        }
    }

    /// The inspected robot.
    #[must_use]
    pub fn inspected_robot(&self) -> Option<AgentId> {
        self.probe.robot
    }

    /// The decision of the inspected robot in the next step, or its last one if its brain does not step then;
    /// `None` if it has made none since the inspection began, or can no longer move.
    pub fn inspection(&mut self) -> Option<Inspected> {
        self.record_decision();
        let robot = self.probe.robot?;
        let last = self.probe.last.as_deref()?;
        Some(Inspected {
            robot,
            tick: last.tick,
            percept: last.percept.clone(),
            decision: last.brain.decision(&last.percept),
        })
    }

    /// Keeps what the brain of the inspected robot has before it steps.
    #[inline]
    pub(super) fn record_decision(&mut self) {
        if let Some(robot) = self.probe.robot {
            self.record_decision_of(robot);
        }
    }

    fn record_decision_of(&mut self, id: AgentId) {
        let number = self.number(id).ok();
        let can_go_on = |robot: &usize| {
            let body_state = &self.state.body_states[*robot];
            body_state.status == Status::Active && !body_state.is_external()
        };
        let Some(robot) = number.filter(can_go_on) else {
            self.probe.forget();
            return;
        };
        if let Ok(Some(percept)) = self.percept(id) {
            self.probe.last = Some(Box::new(Last {
                tick: self.state.tick(),
                percept,
                brain: self.state.agents[robot].brain.clone(),
            }));
        }
    }
}
