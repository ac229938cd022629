//! Reports to the operator that it has not acknowledged.

use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{ContractMessage, GoalId, Refusal};

/// A report that has not been acknowledged is repeated after this time, in seconds.
const RETRY_S: f64 = 2.0;

/// The reports that the operator has not acknowledged, at most one of each goal.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Reports(Vec<Report>);

#[derive(Debug, Clone, Copy, Hashed)]
struct Report {
    goal: GoalId,
    content: ContractMessage,
    next_s: f64,
}

impl Reports {
    /// Reports that no robot can serve a goal, or that it has been lost.
    pub(crate) fn put_unserved(&mut self, report: Refusal, now_s: f64) {
        self.put(report.goal, ContractMessage::Stuck(report), now_s);
    }

    /// Reports that the controller does not own a goal.
    pub(crate) fn put_refused(&mut self, report: Refusal, now_s: f64) {
        self.put(report.goal, ContractMessage::Refuse(report), now_s);
    }

    fn put(&mut self, goal: GoalId, content: ContractMessage, next_s: f64) {
        self.remove(goal);
        self.0.push(Report {
            goal,
            content,
            next_s,
        });
    }

    pub(crate) fn contains(&self, goal: GoalId) -> bool {
        self.0.iter().any(|report| report.goal == goal)
    }

    /// The operator knows, or what was reported is no longer so.
    pub(crate) fn remove(&mut self, goal: GoalId) {
        self.0.retain(|report| report.goal != goal);
    }

    /// The reports that are to be sent now.
    pub(crate) fn due(&mut self, now_s: f64) -> Vec<ContractMessage> {
        let due = self.0.iter_mut().filter(|report| now_s >= report.next_s);
        let due = due.map(|report| {
            report.next_s = now_s + RETRY_S;
            report.content
        });
        due.collect()
    }
}
