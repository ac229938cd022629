//! What a controller reports to the operator of goals, each until the operator has acknowledged it.

use super::Controller;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Dispatch, GoalId, Reason, Refusal};

/// A report that has not been acknowledged is repeated after this time, in seconds.
const RETRY_S: f64 = 2.0;

/// The reports that the operator has not acknowledged, at most one of each goal.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Reports(Vec<Report>);

#[derive(Debug, Clone, Copy, Hashed)]
struct Report {
    goal: GoalId,
    number: u32,
    reason: Reason,
    /// Whether the controller does not own the goal.
    is_refusal: bool,
    next_s: f64,
}

impl Reports {
    fn put(&mut self, report: Report) {
        self.remove(report.goal);
        self.0.push(report);
    }

    pub(super) fn contains(&self, goal: GoalId) -> bool {
        self.0.iter().any(|report| report.goal == goal)
    }

    /// The operator knows, or what was reported is no longer so.
    pub(super) fn remove(&mut self, goal: GoalId) {
        self.0.retain(|report| report.goal != goal);
    }
}

impl Controller {
    /// Reports that no robot can serve a goal, or that it has been lost.
    pub(super) fn report(&mut self, goal: GoalId, number: u32, reason: Reason) {
        self.reports.put(Report {
            goal,
            number,
            reason,
            is_refusal: false,
            next_s: self.now_s,
        });
    }

    /// Reports that it does not own a goal that a person has issued to it.
    pub(super) fn refuse(&mut self, goal: GoalId, reason: Reason) {
        self.refused += 1;
        self.reports.put(Report {
            goal,
            number: 0,
            reason,
            is_refusal: true,
            next_s: self.now_s,
        });
    }

    /// Sends the reports that are due.
    pub(super) fn send_reports(&mut self) {
        for index in 0..self.reports.0.len() {
            let report = &mut self.reports.0[index];
            if self.now_s < report.next_s {
                continue;
            }
            report.next_s = self.now_s + RETRY_S;
            let Report {
                goal,
                number,
                reason,
                is_refusal,
                ..
            } = *report;
            let refusal = Refusal {
                goal,
                number,
                reason,
            };
            let dispatch = if is_refusal {
                Dispatch::Refuse(refusal)
            } else {
                Dispatch::Stuck(refusal)
            };
            self.send(AgentId::OPERATOR, dispatch);
        }
    }
}
