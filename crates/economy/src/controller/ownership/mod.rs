//! The ownership of goals: each has at most one owner, for which a majority of the controllers of its kind votes.
//!
//! [`handover`](super::handover) has the protocol and its states.
//!
//! * [`owner`]: the goals that the controller owns, or is a candidate for; [`renewals`]: the leases under which it owns them;
//! * [`voter`]: the goals of others, and the leases that it grants to their owners; [`transfer`]: goals that are traded.

mod kept;
mod owner;
mod renewals;
mod transfer;
mod voter;

pub use renewals::RENEWAL_RETRY_S;
pub(crate) use transfer::Received;

use super::context::Context;
use super::contracts::Contracts;
use super::handover::Role;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Claim, GoalId, Grantor, LeaseMessage, OwnershipMessage, Task};
use kept::Kept;

/// Longer leases are invalid, in seconds.
const MAX_LEASE_S: f32 = 3600.0;

/// Maximum number of goals of others that are kept, and of served ones that are remembered.
const MAX_KEPT: usize = 10_000;

/// Maximum number of messages about handovers per step.
const MAX_MESSAGES: usize = 8;

#[derive(Debug, Clone, Hashed)]
pub(super) struct Ownership {
    /// Goals that it does not own, and the ownership leases that it has granted.
    kept: Vec<Kept>,
    granted: Grantor,
    /// Goals of others that have been served, the oldest first.
    ended: Vec<GoalId>,
    /// Goals that it has transferred and forgotten, where controllers own goals alone, the oldest first.
    dismissed: Vec<(AgentId, Claim)>,
    next_renewal_s: f64,
}

impl Default for Ownership {
    fn default() -> Self {
        Self {
            kept: Vec::new(),
            granted: Grantor::default(),
            ended: Vec::new(),
            dismissed: Vec::new(),
            next_renewal_s: f64::NEG_INFINITY,
        }
    }
}

impl Ownership {
    /// Requests votes, and renews leases.
    pub(super) fn step(&mut self, context: &mut Context) {
        Self::request_votes(context);
        self.renew_leases(context);
    }

    /// Ends what has ended by the clock.
    pub(super) fn expire(&mut self, context: &mut Context) {
        Self::expire_votes(context);
        self.take_over(context);
    }

    /// It owns goals alone from now on, and forgets those that it does not own.
    pub(super) fn own_alone(&mut self, context: &mut Context, contracts: &mut Contracts) {
        *self = Self::default();
        let ledger = &mut context.ledger;
        ledger.voters.clear();
        let others = ledger
            .goals
            .extract_if(.., |it| it.role != Role::Owner && !it.is_done);
        others.for_each(|other| contracts.forget(other.task.id));
        ledger
            .goals
            .iter_mut()
            .for_each(|owned| owned.votes.clear());
    }

    /// Takes a message of another controller of its kind.
    pub(super) fn receive(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        from: AgentId,
        message: OwnershipMessage,
    ) {
        match message {
            OwnershipMessage::Entrust(request) => {
                self.take_request(context, contracts, from, request);
            }
            OwnershipMessage::Entrusted(vote) => Self::take_vote(context, from, vote),
            OwnershipMessage::Assigned(assignment) => {
                self.take_assignment(context, from, assignment);
            }
            OwnershipMessage::Release(claim) => self.take_release(context, from, claim),
            OwnershipMessage::Ended(goal) => self.take_end(context, from, goal),
            OwnershipMessage::Noted(goal) => Self::take_note(context, from, goal),
            OwnershipMessage::Present {} | OwnershipMessage::Seen(_) => {}
        }
    }

    /// Takes a message of another controller of its kind about ownership leases.
    pub(super) fn renew(&mut self, context: &mut Context, from: AgentId, message: LeaseMessage) {
        match message {
            LeaseMessage::Renew(renewal) => self.renew_granted(context, from, renewal),
            LeaseMessage::RenewOne(claim) => self.renew_one_granted(context, from, claim),
            answer => Self::take_renewal(context, from, answer),
        }
    }

    /// The goals that no controller owns, as it has reported.
    pub(super) fn lost(&self) -> impl Iterator<Item = Task> {
        let lost = self.kept.iter().filter(|kept| kept.is_reported);
        lost.map(|kept| kept.task)
    }

    /// Whether it keeps the description of a goal.
    pub(super) fn knows(&self, goal: GoalId) -> bool {
        self.kept.iter().any(|kept| kept.task.id == goal)
    }
}
