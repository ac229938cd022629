//! The voter's half: it keeps the descriptions of goals, votes for their owners, and becomes a candidate when these are lost.

use super::kept::Kept;
use super::{MAX_KEPT, Ownership};
use crate::controller::context::{Context, short};
use crate::controller::contracts::Contracts;
use crate::controller::handover::{Role, TURN_S};
use crate::controller::ledger::owned::{Owned, note_assignee};
use brain::{
    AgentId, Assignment, Award, Claim, Entrust, GoalId, LeaseMessage, OwnershipMessage, Renewal,
};

impl Ownership {
    /// An owner or a candidate requests the vote for a goal.
    pub(super) fn take_request(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        from: AgentId,
        Entrust { number, task }: Entrust,
    ) {
        if !task.is_valid() || !context.may_grant() {
            return;
        }
        let goal = task.id;
        if self.has_ended(context, goal) {
            context.send(from, OwnershipMessage::Ended(goal));
            return;
        }
        let own_role = context.ledger.get(goal).map(|owned| owned.role);
        match own_role {
            Some(Role::Owner) => return,
            Some(Role::Candidate { .. }) if from < context.own => return,
            Some(Role::Candidate { .. }) => self.keep(context, contracts, goal),
            None => {}
        }
        let claim = Claim { goal, number };
        let is_kept = self.kept_mut(goal).is_some();
        if context.votes_needed() == 0 && !is_kept {
            return self.answer_dismissed(context, from, claim);
        }
        if self.kept.len() >= MAX_KEPT && !is_kept {
            return;
        }
        let (now_s, wait_s) = (context.now_s, context.owner_wait_s());
        if !self.granted.grant_again(from, claim, wait_s, now_s) {
            return;
        }
        let due_at_s = now_s + f64::from(task.due_s);
        match self.kept_mut(goal) {
            Some(kept) => {
                (kept.task, kept.due_at_s, kept.owner) = (task, due_at_s, from);
                (kept.turn_s, kept.is_reported) = (f64::INFINITY, false);
            }
            None => self.kept.push(Kept::new(task, due_at_s, from)),
        }
        let lease_s = short(context.settings.owner_lease_s);
        let vote = Award {
            goal,
            number,
            lease_s,
        };
        context.send(from, OwnershipMessage::Entrusted(vote));
    }

    /// Whether it knows that a goal has been served.
    pub(super) fn has_ended(&self, context: &Context, goal: GoalId) -> bool {
        let is_done = context.ledger.get(goal).is_some_and(|owned| owned.is_done);
        is_done || self.ended.contains(&goal)
    }

    pub(super) fn kept_mut(&mut self, goal: GoalId) -> Option<&mut Kept> {
        self.kept.iter_mut().find(|kept| kept.task.id == goal)
    }

    /// Notes a robot to which the owner of a goal has awarded it: it may report that the goal is done
    /// after this controller has taken it over. The message may arrive after that.
    pub(super) fn take_assignment(
        &mut self,
        context: &mut Context,
        from: AgentId,
        assignment: Assignment,
    ) {
        let Assignment { goal, robot } = assignment;
        if !robot.is_robot() {
            return;
        }
        if let Some(kept) = self.kept_mut(goal).filter(|kept| kept.owner == from) {
            note_assignee(&mut kept.assignees, robot);
        }
        let owned = context.ledger.get_mut(goal);
        if let Some(owned) = owned.filter(|owned| owned.origin == Some(from)) {
            note_assignee(&mut owned.assignees, robot);
        }
    }

    /// Renews the leases by which the sender owns its goals.
    pub(super) fn renew_granted(&mut self, context: &mut Context, from: AgentId, renewal: Renewal) {
        let answer = if self.granted.renew(from, renewal, context.now_s) {
            LeaseMessage::Renewed(renewal.number)
        } else {
            LeaseMessage::Differs(renewal.number)
        };
        context.send(from, answer);
    }

    /// Renews one lease.
    pub(super) fn renew_one_granted(&mut self, context: &mut Context, from: AgentId, claim: Claim) {
        if self.granted.renew_one(from, claim, context.now_s) {
            context.send(from, LeaseMessage::RenewedOne(claim));
        }
    }

    /// The controller for which it voted owns the goal no longer.
    pub(super) fn take_release(&mut self, context: &Context, from: AgentId, claim: Claim) {
        if self.granted.release(from, claim).is_some() {
            self.await_turn(context, claim.goal);
        }
    }

    /// A goal has been served, as the controller knows that owns or owned it.
    pub(super) fn take_end(&mut self, context: &mut Context, from: AgentId, goal: GoalId) {
        let is_trusted = |owned: &Owned| {
            let is_candidate = owned.role != Role::Owner;
            owned.is_done || is_candidate || owned.origin == Some(from)
        };
        let owned = context.ledger.get(goal);
        let grant = self.granted.grant_of(goal);
        let is_of_another = grant.is_some_and(|grant| grant.holder != from);
        if is_of_another || owned.is_some_and(|owned| !is_trusted(owned)) {
            return;
        }
        let now_s = context.now_s;
        match context.ledger.get_mut(goal) {
            Some(owned) if owned.is_done => {}
            Some(owned) => owned.finish(now_s),
            None => self.end(goal),
        }
        context.send(from, OwnershipMessage::Noted(goal));
    }

    /// It votes for no controller as the owner of a goal any more.
    fn end(&mut self, goal: GoalId) {
        self.kept.retain(|kept| kept.task.id != goal);
        self.granted.end(goal);
        if self.ended.contains(&goal) {
            return;
        }
        if self.ended.len() >= MAX_KEPT {
            self.ended.remove(0);
        }
        self.ended.push(goal);
    }

    /// The owner of a goal is lost, or has released it: this controller becomes a candidate when it is its turn.
    fn await_turn(&mut self, context: &Context, goal: GoalId) {
        let (own, now_s) = (context.own, context.now_s);
        let peers = &context.peers;
        if let Some(kept) = self.kept_mut(goal) {
            let owner = kept.owner;
            let before = peers.members_of(own).filter(|id| *id > own || *id == owner);
            #[expect(clippy::cast_precision_loss, reason = "few controllers")]
            let turns = before.count() as f64;
            kept.turn_s = now_s + TURN_S * turns;
        }
    }

    /// Becomes a candidate for the goals whose owners have been lost.
    pub(super) fn take_over(&mut self, context: &mut Context) {
        for grant in self.granted.expire(context.now_s) {
            self.await_turn(context, grant.goal);
        }
        if !context.may_grant() {
            return;
        }
        let now_s = context.now_s;
        let due = self.kept.extract_if(.., |kept| now_s >= kept.turn_s);
        for kept in due {
            let mut owned = Owned::new(kept.task, now_s, f64::NEG_INFINITY);
            (owned.due_at_s, owned.limit_s) = (kept.due_at_s, kept.limit_s);
            owned.giver = kept.giver.filter(|_| context.votes_needed() == 0);
            owned.origin = owned.giver.or(Some(kept.owner));
            (owned.assignees, owned.is_reported) = (kept.assignees, kept.is_reported);
            context.ledger.goals.push(owned);
            context.count_votes_for(kept.task.id);
        }
    }
}
