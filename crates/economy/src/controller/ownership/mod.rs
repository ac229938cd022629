//! The ownership of goals: each has one owner, and a backup that takes it over when the owner is lost.
//!
//! [`handover`](super::handover) has the protocol and its states.
//!
//! * [`owner`]: the goals that the controller owns, or has lost; [`renewals`]: the leases under which it owns them;
//! * [`backup`]: the goals of others, and the leases that it grants to their owners.

mod backup;
mod kept;
mod lost;
mod owner;
mod renewals;

pub use renewals::RENEWAL_RETRY_S;

use super::context::Context;
use super::contracts::Contracts;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, GoalId, Grantor, LeaseMessage, OwnershipMessage, Task};
use kept::Kept;
use lost::Lost;

/// Longer leases are invalid, in seconds.
const MAX_LEASE_S: f32 = 3600.0;

/// Maximum number of goals of others of which it is the backup.
const MAX_KEPT: usize = 10_000;

/// Maximum number of messages about handovers per step.
const MAX_MESSAGES: usize = 4;

#[derive(Debug, Clone, Hashed)]
pub(super) struct Ownership {
    /// Goals of which it is the backup, and the ownership leases that it has granted.
    kept: Vec<Kept>,
    granted: Grantor,
    /// Goals that it owned until its lease ended.
    lost: Vec<Lost>,
    next_renewal_s: f64,
}

impl Default for Ownership {
    fn default() -> Self {
        Self {
            kept: Vec::new(),
            granted: Grantor::default(),
            lost: Vec::new(),
            next_renewal_s: f64::NEG_INFINITY,
        }
    }
}

impl Ownership {
    /// Hands over goals to backups, or back to previous owners, and renews leases.
    pub(super) fn step(&mut self, context: &mut Context, contracts: &Contracts) {
        let mut left = MAX_MESSAGES;
        for index in 0..context.ledger.goals.len() {
            if left == 0 {
                break;
            }
            if Self::hand_over(context, contracts, index) {
                left -= 1;
            }
        }
        self.renew_leases(context);
    }

    /// Ends what has ended by the clock.
    pub(super) fn expire(&mut self, context: &mut Context, contracts: &mut Contracts) {
        self.lose(context, contracts);
        self.take_over(context);
    }

    /// Takes a message of a peer.
    pub(super) fn receive(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        from: AgentId,
        message: OwnershipMessage,
    ) {
        match message {
            OwnershipMessage::Entrust(task) => self.take_entrusted(context, contracts, from, task),
            OwnershipMessage::Entrusted(answer) => self.take_answer(context, from, answer),
            OwnershipMessage::Assigned(assignment) => {
                self.take_assignment(context, from, assignment);
            }
            OwnershipMessage::Bind(binding) => self.take_binding(context, contracts, from, binding),
            OwnershipMessage::Relieve(claim) => self.take_relief(context, from, claim),
            OwnershipMessage::Relieved(claim) => Self::take_relieved(context, from, claim),
            OwnershipMessage::Restore(task) => self.take_return(context, from, task),
            OwnershipMessage::Serial(_) | OwnershipMessage::Seen(_) => {}
        }
    }

    /// Takes a message of a peer about ownership leases.
    pub(super) fn renew(&mut self, context: &mut Context, from: AgentId, message: LeaseMessage) {
        let now_s = context.now_s;
        match message {
            LeaseMessage::Renew(renewal) => self.renew_granted(context, from, renewal),
            LeaseMessage::RenewOne(claim) => self.renew_one_granted(context, from, claim),
            LeaseMessage::Renewed(number) => context.ledger.leases.renew(from, number, now_s),
            LeaseMessage::RenewedOne(claim) => context.ledger.leases.renew_one(from, claim, now_s),
            LeaseMessage::Differs(number) => Self::renew_one_by_one(context, from, number),
        }
    }

    /// The goals that it owned until their lease ended.
    pub(super) fn lost(&self) -> impl Iterator<Item = Task> {
        self.lost.iter().map(|lost| lost.owned.task)
    }

    /// Whether it is the backup to which the owner of a goal is bound, or has lost it.
    pub(super) fn knows(&self, goal: GoalId) -> bool {
        let is_backup = |kept: &Kept| kept.is_bound && kept.task.id == goal;
        self.kept.iter().any(is_backup) || self.is_lost(goal)
    }

    fn is_lost(&self, goal: GoalId) -> bool {
        self.lost.iter().any(|lost| lost.owned.task.id == goal)
    }
}
