//! A goal that a controller does not own: it votes for an owner, and takes the goal over when that is lost.

use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Task};

#[derive(Debug, Clone, Hashed)]
pub(super) struct Kept {
    pub(super) task: Task,
    pub(super) due_at_s: f64,
    /// The last owner or candidate that it knows of: it may have lost the goal itself.
    pub(super) owner: AgentId,
    /// The controller that has transferred it to this one, and without which it cannot own it.
    pub(super) giver: Option<AgentId>,
    /// The cost that the price of another controller has to be below, if this one had the goal by trade.
    pub(super) limit_s: f64,
    /// Whether it has been reported that no controller owns it, as far as this controller knows.
    pub(super) is_reported: bool,
    /// When this controller becomes a candidate; infinity while it votes for another.
    pub(super) turn_s: f64,
    /// The robots that owners have awarded it to, as far as their messages arrived.
    pub(super) assignees: Vec<AgentId>,
}

impl Kept {
    /// A goal of another controller, for which this one votes.
    pub(super) fn new(task: Task, due_at_s: f64, owner: AgentId) -> Self {
        Self {
            task,
            due_at_s,
            owner,
            giver: None,
            limit_s: f64::INFINITY,
            is_reported: false,
            turn_s: f64::INFINITY,
            assignees: Vec::new(),
        }
    }
}
