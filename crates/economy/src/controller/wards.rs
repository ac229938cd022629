//! Goals of lost owners: those of which a controller is the heir, and those that it has lost itself.

use super::owned::Owned;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Task};

/// A goal of another controller, of which this one is the heir.
#[derive(Debug, Clone, Hashed)]
pub(super) struct Ward {
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

impl Ward {
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

/// A goal that a controller owned until its lease ended.
#[derive(Debug, Clone, Hashed)]
pub(super) struct Orphan {
    pub(super) owned: Owned,
    /// The request by which it would be owned again.
    pub(super) request: Option<Request>,
}

/// A request of an owner lease by which an heir can return a goal.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(super) struct Request {
    pub(super) number: u32,
    pub(super) heir: AgentId,
    /// The lease counts from then.
    pub(super) sent_s: f64,
}
