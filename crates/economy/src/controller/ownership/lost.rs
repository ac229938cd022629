//! A goal that a controller owned until its lease ended.

use crate::controller::ledger::owned::Owned;
use base::hashed::Hashed;
use brain::AgentId;

#[derive(Debug, Clone, Hashed)]
pub(super) struct Lost {
    pub(super) owned: Owned,
    /// The request by which it would be owned again.
    pub(super) request: Option<Request>,
}

/// A request of an ownership lease by which a backup can return a goal.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(super) struct Request {
    pub(super) number: u32,
    pub(super) backup: AgentId,
    /// The lease counts from then.
    pub(super) sent_s: f64,
}
