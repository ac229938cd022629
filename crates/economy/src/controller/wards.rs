//! Goals of lost owners: those of which a controller is the heir, and those that it has lost itself.

use super::owned::Owned;
use brain::{RobotId, Task};

/// A goal of another controller, of which this one is the heir.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ward {
    pub(super) task: Task,
    pub(super) due_at_s: f64,
    pub(super) owner: RobotId,
    /// Number of the answer that the owner has to name.
    pub(super) number: u32,
    pub(super) is_bound: bool,
    /// How long the owner's service leases can last after its own lease.
    pub(super) service_wait_s: f64,
}

base::hashed!(Ward {
    task,
    due_at_s,
    owner,
    number,
    is_bound,
    service_wait_s
});

/// A goal that a controller owned until its lease ended.
#[derive(Debug, Clone)]
pub(super) struct Orphan {
    pub(super) owned: Owned,
    /// The request by which it would be owned again.
    pub(super) request: Option<u32>,
}

base::hashed!(Orphan { owned, request });
