//! The backup's half: it keeps the descriptions of goals, grants and renews the leases of their owners, and owns the
//! goals of lost owners until it can return them.

use super::kept::Kept;
use super::{MAX_KEPT, MAX_LEASE_S, Ownership};
use crate::controller::context::{Context, short};
use crate::controller::contracts::Contracts;
use crate::controller::handover::Handover;
use crate::controller::ledger::owned::{Owned, note_assignee};
use brain::{
    AgentId, Assignment, Award, Claim, GoalId, LeaseMessage, OwnershipMessage, Renewal, Task,
    wait_s,
};

impl Ownership {
    /// Takes the description of a goal of which it is to be the backup.
    pub(super) fn take_entrusted(
        &mut self,
        context: &mut Context,
        contracts: &Contracts,
        from: AgentId,
        task: Task,
    ) {
        give_up(context, contracts, from, task.id);
        let is_own = context.ledger.has_undone(task.id);
        let is_full = self.kept.len() >= MAX_KEPT;
        let known = self.kept.iter().find(|kept| kept.task.id == task.id);
        let number = match known {
            _ if is_own || !task.is_valid() || !context.may_grant() => return,
            Some(kept) if kept.owner == from => kept.number,
            Some(kept) if kept.is_bound => return,
            None if is_full => return,
            _ => {
                self.kept.retain(|kept| kept.task.id != task.id);
                let number = context.numbers.draw();
                let due_at_s = context.now_s + f64::from(task.due_s);
                self.kept.push(Kept::new(task, due_at_s, from, number));
                number
            }
        };
        confirm(
            context,
            from,
            Claim {
                goal: task.id,
                number,
            },
        );
    }

    /// An owner is bound: its lease begins. A binding that names another answer has no effect.
    pub(super) fn take_binding(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        from: AgentId,
        binding: Award,
    ) {
        let Award {
            goal,
            number,
            lease_s,
        } = binding;
        if !(0.0..=MAX_LEASE_S).contains(&lease_s) {
            return;
        }
        let claim = Claim { goal, number };
        self.release_to(context, contracts, from, claim);
        let service_wait_s = wait_s(lease_s.into(), context.settings.max_drift);
        let (now_s, owner_wait_s) = (context.now_s, context.owner_wait_s());
        let mut all = self.kept.iter_mut();
        let Some(kept) = all.find(|kept| kept.task.id == goal && kept.owner == from) else {
            return;
        };
        if kept.number != number {
            let number = kept.number;
            confirm(context, from, Claim { goal, number });
            return;
        }
        let is_granted = self.granted.grant(from, claim, owner_wait_s, now_s)
            || self.granted.renew_one(from, claim, now_s);
        if is_granted {
            (kept.is_bound, kept.service_wait_s) = (true, service_wait_s);
            confirm(context, from, claim);
        }
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
        let mut all = self.kept.iter_mut();
        if let Some(kept) = all.find(|kept| kept.task.id == goal && kept.owner == from) {
            note_assignee(&mut kept.assignees, robot);
        }
        let owned = context.ledger.get_mut(goal);
        if let Some(owned) = owned.filter(|owned| owned.origin == Some(from)) {
            note_assignee(&mut owned.assignees, robot);
        }
    }

    /// A goal that it has taken over and that no robot serves belongs to its previous owner, which answered
    /// that it owns the goal again. It is the backup again.
    fn release_to(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        origin: AgentId,
        claim: Claim,
    ) {
        let Claim { goal, number } = claim;
        let mut goals = context.ledger.goals.iter();
        let index = goals.position(|owned| {
            let is_returned = owned.task.id == goal && owned.origin == Some(origin);
            is_returned
                && owned.handover == Handover::Alone
                && !owned.is_done
                && owned.next_return_s.is_finite()
        });
        let Some(index) = index.filter(|_| contracts.is_free(goal)) else {
            return;
        };
        let owned = context.ledger.goals.remove(index);
        contracts.forget_bids(goal);
        let mut kept = Kept::new(owned.task, owned.due_at_s, origin, number);
        kept.assignees = owned.assignees;
        self.kept.push(kept);
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

    /// Renews one lease. A controller that is not the backup answers that.
    pub(super) fn renew_one_granted(&mut self, context: &mut Context, from: AgentId, claim: Claim) {
        if self.granted.renew_one(from, claim, context.now_s) {
            context.send(from, LeaseMessage::RenewedOne(claim));
        } else {
            self.take_relief(context, from, claim);
        }
    }

    /// It is the backup no longer, unless it owns the goal by now.
    pub(super) fn take_relief(&mut self, context: &mut Context, from: AgentId, claim: Claim) {
        let is_of_another = |kept: &Kept| kept.task.id == claim.goal && kept.owner != from;
        if context.ledger.has_undone(claim.goal) || self.kept.iter().any(is_of_another) {
            return;
        }
        self.kept.retain(|kept| kept.task.id != claim.goal);
        self.granted.end(claim.goal);
        context.send(from, OwnershipMessage::Relieved(claim));
    }

    /// Owns the goals whose owners have been lost.
    pub(super) fn take_over(&mut self, context: &mut Context) {
        for grant in self.granted.expire(context.now_s) {
            let mut all = self.kept.iter();
            let Some(index) = all.position(|kept| kept.task.id == grant.goal && kept.is_bound)
            else {
                continue;
            };
            let kept = self.kept.remove(index);
            let mut owned = Owned::new(kept.task, context.now_s, kept.service_wait_s);
            owned.due_at_s = kept.due_at_s;
            (owned.origin, owned.assignees) = (Some(kept.owner), kept.assignees);
            let goals = &mut context.ledger.goals;
            goals.retain(|owned| owned.task.id != grant.goal);
            goals.push(owned);
        }
    }
}

/// A goal that it has taken over belongs to its previous owner again, to which a person has issued it
/// meanwhile: two controllers own it. It gives it up if no robot serves it for it.
fn give_up(context: &mut Context, contracts: &Contracts, origin: AgentId, goal: GoalId) {
    if contracts.is_free(goal) {
        context.ledger.goals.retain(|owned| {
            let is_alone = owned.handover == Handover::Alone && !owned.is_done;
            !(owned.task.id == goal && owned.origin == Some(origin) && is_alone)
        });
    }
}

fn confirm(context: &mut Context, owner: AgentId, Claim { goal, number }: Claim) {
    let lease_s = short(context.settings.owner_lease_s);
    let answer = Award {
        goal,
        number,
        lease_s,
    };
    context.send(owner, OwnershipMessage::Entrusted(answer));
}
