//! A goal of another controller, of which this one is the backup.

use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Task};

#[derive(Debug, Clone, Hashed)]
pub(super) struct Kept {
    pub(super) task: Task,
    pub(super) due_at_s: f64,
    pub(super) owner: AgentId,
    /// Number of the answer that the owner has to name.
    pub(super) number: u32,
    pub(super) is_bound: bool,
    /// How long the owner's service leases can last after its own lease.
    pub(super) service_wait_s: f64,
    /// The robots that the owner has awarded it to, as far as its messages arrived.
    pub(super) assignees: Vec<AgentId>,
}

impl Kept {
    /// A goal whose owner is not bound yet.
    pub(super) fn new(task: Task, due_at_s: f64, owner: AgentId, number: u32) -> Self {
        Self {
            task,
            due_at_s,
            owner,
            number,
            is_bound: false,
            service_wait_s: 0.0,
            assignees: Vec::new(),
        }
    }
}
