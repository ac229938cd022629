//! Goals that a controller has lost are reported to the operator.

use super::Controller;
use alloc::vec::Vec;
use brain::{AgentId, Dispatch, GoalId, Reason, Refusal};

impl Controller {
    /// Reports the goals that it has lost to the operator, except for the first `known` ones.
    pub(super) fn report_orphans(&mut self, known: usize) {
        let lost = self.orphans.iter().skip(known);
        let lost: Vec<GoalId> = lost.map(|orphan| orphan.owned.task.id).collect();
        for goal in lost {
            let refusal = Refusal {
                goal,
                number: 0,
                reason: Reason::Orphaned,
            };
            self.send(AgentId::OPERATOR, Dispatch::Stuck(refusal));
        }
    }
}
