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
use super::ledger::owned::Owned;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Claim, GoalId, Grantor, LeaseMessage, OwnershipMessage, Task};
use kept::Kept;

/// Longer leases are invalid, in seconds.
const MAX_LEASE_S: f32 = 3600.0;

/// Maximum number of goals of others that are kept, and of served ones that are remembered.
const MAX_KEPT: usize = 10_000;

/// Maximum number of messages about handovers per step.
pub(crate) const MAX_MESSAGES: usize = 8;

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
        let now_s = context.now_s;
        let ledger = &mut context.ledger;
        ledger.voters.clear();
        let is_other = |it: &mut Owned| !it.is_held(now_s) && !it.is_done;
        let others = ledger.goals.extract_if(.., is_other);
        others.for_each(|other| contracts.forget(other.task.id));
        ledger
            .goals
            .iter_mut()
            .for_each(|owned| owned.votes.clear());
    }

    /// Goals that controllers have transferred to it that a person has removed. Those that it owns are its own; others may have
    /// been transferred to another one since, and are forgotten.
    pub(super) fn forget_peers(
        &mut self,
        context: &mut Context,
        is_removed: &impl Fn(AgentId) -> bool,
    ) {
        let now_s = context.now_s;
        let is_left = |giver: Option<AgentId>| giver.is_some_and(is_removed);
        self.kept.retain(|kept| !is_left(kept.giver));
        let goals = &mut context.ledger.goals;
        goals.retain(|owned| owned.is_done || owned.is_held(now_s) || !is_left(owned.giver));
        for owned in goals.iter_mut().filter(|owned| is_left(owned.giver)) {
            owned.giver = None;
        }
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
