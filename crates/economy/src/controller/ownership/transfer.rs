//! The transfer of a goal to another controller, to which its owner has agreed.

use super::{MAX_KEPT, Ownership};
use crate::controller::context::Context;
use crate::controller::contracts::Contracts;
use crate::controller::handover::NO_REQUEST;
use crate::controller::ledger::owned::Owned;
use alloc::vec::Vec;
use brain::{AgentId, Claim, GoalId, OwnershipMessage, Task, TradeMessage, Transfer};

/// A goal that another controller transfers to this one.
pub(crate) struct Received {
    pub(crate) task: Task,
    /// Its deadline on this controller's clock.
    pub(crate) due_at_s: f64,
    pub(crate) transfer: Transfer,
    pub(crate) from: AgentId,
    /// When this controller has sent its price: the sender has owned the goal after that.
    pub(crate) priced_s: f64,
}

impl Ownership {
    /// It owns a goal no longer: another one is to be a candidate for it within a time. Returns the number of the request by
    /// which that one has voted for it, or 0.
    pub(crate) fn transfer(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        (goal, to): (GoalId, AgentId),
        within_s: f64,
    ) -> u32 {
        let mut lease = NO_REQUEST;
        for (voter, claim) in context.ledger.release(goal) {
            if voter == to {
                lease = claim.number;
            } else {
                context.send(voter, OwnershipMessage::Release(claim));
            }
        }
        self.keep(context, contracts, goal);
        let turn_s = context.now_s + within_s;
        if let Some(kept) = self.kept_mut(goal) {
            (kept.owner, kept.turn_s) = (to, turn_s);
        }
        context.close_offer(goal, None);
        lease
    }

    /// It is a candidate for a goal that its owner transfers to it, unless it votes for another one. No robot holds a lease of
    /// it until another controller could have owned and lost it since the price: that takes at least an ownership lease.
    pub(crate) fn take_transfer(
        &mut self,
        context: &mut Context,
        Received {
            task,
            due_at_s,
            transfer,
            from,
            priced_s,
        }: Received,
    ) {
        let (goal, now_s) = (task.id, context.now_s);
        if context.ledger.get(goal).is_some() || self.has_ended(context, goal) {
            return;
        }
        if let Some(grant) = self.granted.grant_of(goal) {
            if grant.holder != from || grant.number != transfer.lease {
                return;
            }
            self.granted.end(goal);
        }
        self.kept.retain(|kept| kept.task.id != goal);
        self.dismissed.retain(|(_, claim)| claim.goal != goal);
        let free_until_s = priced_s + context.settings.owner_lease_s / 2.0;
        let mut owned = Owned::new(task, now_s, free_until_s);
        (owned.origin, owned.due_at_s) = (Some(from), due_at_s);
        owned.giver = (context.votes_needed() == 0).then_some(from);
        owned.limit_s = transfer.limit_s.into();
        context.ledger.goals.push(owned);
        context.count_votes_for(goal);
    }

    /// A controller to which it has transferred a goal owns it, where controllers own goals alone: it forgets the goal. The
    /// number is that of this transfer, and not of an earlier one between the two.
    pub(crate) fn take_dismissal(&mut self, context: &mut Context, from: AgentId, claim: Claim) {
        let grant = self.granted.grant_of(claim.goal);
        let is_granted =
            grant.is_some_and(|grant| grant.holder == from && grant.number == claim.number);
        if context.votes_needed() == 0 && is_granted {
            self.kept.retain(|kept| kept.task.id != claim.goal);
            self.granted.end(claim.goal);
            if self.dismissed.len() >= MAX_KEPT {
                self.dismissed.remove(0);
            }
            self.dismissed.push((from, claim));
        }
        if self.dismissed.contains(&(from, claim)) {
            context.send(from, TradeMessage::Dismissed(claim));
        }
    }

    /// A controller that has lost the lease of a goal requests it again. If it was the last to which this one has transferred
    /// the goal, it owns that alone.
    pub(super) fn answer_dismissed(&self, context: &mut Context, from: AgentId, claim: Claim) {
        let mut transferred = self.dismissed.iter().rev();
        let last = transferred.find(|(_, dismissed)| dismissed.goal == claim.goal);
        if last.is_some_and(|(to, _)| *to == from) {
            context.send(from, TradeMessage::Dismissed(claim));
        }
    }

    /// The controller that has transferred a goal has forgotten it: this one owns it alone.
    pub(crate) fn own_after(context: &mut Context, from: AgentId, claim: Claim) {
        let (goal, now_s) = (claim.goal, context.now_s);
        let owned = context.ledger.get_mut(goal);
        let Some(owned) = owned.filter(|owned| owned.giver == Some(from)) else {
            return;
        };
        if owned.vote_of(from, now_s).number != claim.number {
            return;
        }
        (owned.giver, owned.votes) = (None, Vec::new());
        context.ledger.leases_of(from).release(goal);
        context.count_votes_for(goal);
    }

    /// The controller that it votes for as the owner of a goal.
    pub(crate) fn votes_for(&self, goal: GoalId) -> Option<AgentId> {
        Some(self.granted.grant_of(goal)?.holder)
    }
}
