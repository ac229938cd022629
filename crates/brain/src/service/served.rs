//! What pages and recordings show of the goals that a robot serves.

use super::assignee::Assignee;
use crate::io::agent_id::AgentId;
use crate::io::verdict::Verdict;
use crate::io::work::Task;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A goal of a controller that a robot serves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ServedGoal {
    /// The goal.
    pub task: Task,
    /// The controller that awarded it.
    pub owner: AgentId,
    /// Remaining time of its lease, on the robot's clock.
    pub lease_s: f64,
    /// Its state.
    pub verdict: Verdict,
}

impl Assignee {
    /// The goals that it serves, in their order.
    pub(crate) fn served(&self) -> Vec<ServedGoal> {
        let jobs = self.jobs.list.iter();
        let served = jobs.filter_map(|job| {
            let lease = self.holder.lease(job.task.id)?;
            Some(ServedGoal {
                task: job.task,
                owner: job.owner,
                lease_s: lease.until_s - self.now_s,
                verdict: job.verdict,
            })
        });
        served.collect()
    }
}
