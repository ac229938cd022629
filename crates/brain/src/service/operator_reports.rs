//! Reports to the operator that it has not acknowledged.

use crate::io::contract::{ContractMessage, Refusal};
use crate::io::goal_id::GoalId;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// A report that has not been acknowledged is repeated after this time, in seconds.
const RETRY_S: f64 = 2.0;

/// The reports of an agent that the operator has not acknowledged, at most one of each goal.
#[derive(Debug, Clone, Default, Hashed)]
pub struct OperatorReports(Vec<Report>);

#[derive(Debug, Clone, Copy, Hashed)]
struct Report {
    goal: GoalId,
    content: ContractMessage,
    next_s: f64,
}

impl OperatorReports {
    /// Reports that a goal is not being served: no robot can, its owner has lost it, or the lease of its robot has ended.
    pub fn put_unserved(&mut self, report: Refusal, now_s: f64) {
        self.put(report.goal, ContractMessage::Stuck(report), now_s);
    }

    /// Reports that a controller does not own a goal.
    pub fn put_refused(&mut self, report: Refusal, now_s: f64) {
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

    /// The goals of which there are reports.
    pub fn goals(&self) -> impl Iterator<Item = GoalId> {
        self.0.iter().map(|report| report.goal)
    }

    /// The operator knows, or what was reported is no longer so.
    pub fn remove(&mut self, goal: GoalId) {
        self.0.retain(|report| report.goal != goal);
    }

    /// The reports that are to be sent now.
    pub fn due(&mut self, now_s: f64) -> Vec<ContractMessage> {
        let due = self.0.iter_mut().filter(|report| now_s >= report.next_s);
        let due = due.map(|report| {
            report.next_s = now_s + RETRY_S;
            report.content
        });
        due.collect()
    }
}
