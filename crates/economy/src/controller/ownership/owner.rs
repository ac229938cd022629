//! The owner's half: it hands over its goals to backups, owns them under their leases, and owns again what they return.

use super::lost::{Lost, Request};
use super::{MAX_LEASE_S, Ownership};
use crate::controller::context::{Context, short};
use crate::controller::contracts::Contracts;
use crate::controller::handover::{Action, Handover, RETRY_S, Situation};
use crate::controller::ledger::owned::Owned;
use brain::{AgentId, Award, Claim, GoalId, OwnershipMessage, Reason, Refusal, Task};

impl Ownership {
    /// Owns a goal that a person has issued. One that it has lost is awarded when all leases of it have ended.
    pub(crate) fn take_issued(&mut self, context: &mut Context, task: Task) {
        context.ledger.reports.remove(task.id);
        let wait_s = if self.is_lost(task.id) {
            context.service_wait_s()
        } else {
            0.0
        };
        match context.own(task, wait_s) {
            Ok(()) => self.lost.retain(|lost| lost.owned.task.id != task.id),
            Err(reason) => {
                context.ledger.refused += 1;
                let refusal = Refusal {
                    goal: task.id,
                    number: 0,
                    reason,
                };
                context.ledger.reports.put_refused(refusal, context.now_s);
            }
        }
    }

    /// Takes the answer of a backup: that it is ready, that it knows that it is bound, or that it
    /// returns the goal.
    pub(super) fn take_answer(&mut self, context: &mut Context, from: AgentId, answer: Award) {
        let Award {
            goal,
            number,
            lease_s,
        } = answer;
        let min_lease_s = short(context.settings.min_owner_lease_s());
        if !(min_lease_s..=MAX_LEASE_S).contains(&lease_s) {
            return;
        }
        let (now_s, claim) = (context.now_s, Claim { goal, number });
        match context
            .ledger
            .get_mut(goal)
            .map(|owned| &mut owned.handover)
        {
            Some(Handover::Offered { backup, .. }) if *backup == from => {
                // The lease counts from the first binding: the backup may receive any of them.
                let leases = &mut context.ledger.leases;
                leases.request(number, from, Some(goal), now_s);
                leases.accept(from, claim, lease_s.into(), now_s);
                bind(context, goal, from, number);
            }
            Some(Handover::Bound {
                backup,
                number: bound,
                is_confirmed,
                ..
            }) if *backup == from && *bound == number => {
                *is_confirmed = true;
                context.report_assignees(goal);
            }
            // It names another answer than the one to which the binding refers.
            Some(Handover::Bound {
                backup,
                is_confirmed: false,
                ..
            }) if *backup == from => bind(context, goal, from, number),
            None => self.take_back(context, from, claim, lease_s.into()),
            Some(_) => {}
        }
    }

    /// The ownership of a goal whose lease has ended is lost, as far as this controller knows.
    pub(super) fn lose(&mut self, context: &mut Context, contracts: &mut Contracts) {
        for goal in context.ledger.leases.expire(context.now_s) {
            let mut goals = context.ledger.goals.iter();
            let Some(index) = goals.position(|owned| owned.task.id == goal) else {
                continue;
            };
            context.ledger.goals[index].handover = Handover::Alone;
            if !context.ledger.goals[index].is_done {
                let mut owned = context.ledger.goals.remove(index);
                owned.assigned = None;
                let request = None;
                self.lost.push(Lost { owned, request });
                context.report(goal, 0, Reason::OwnershipLost);
                contracts.forget(goal);
            }
        }
    }

    /// A robot reports that it has served a goal whose ownership is lost: it is lost no longer.
    pub(crate) fn restore_done(&mut self, context: &mut Context, from: AgentId, goal: GoalId) {
        let mut all = self.lost.iter();
        let index =
            all.position(|lost| lost.owned.task.id == goal && lost.owned.assignees.contains(&from));
        if let Some(index) = index {
            let mut owned = self.lost.remove(index).owned;
            owned.is_done = true;
            context.ledger.goals.push(owned);
        }
    }

    /// A backup returns a goal: the answer is the request of the lease. A repeated offer has the same answer
    /// for a time, because the messages of both may take longer than the backup waits.
    pub(super) fn take_return(&mut self, context: &mut Context, from: AgentId, task: Task) {
        rejoin(context, from, task.id);
        let is_own = context.ledger.get(task.id).is_some();
        let is_full = self.lost.len() >= context.settings.max_goals as usize;
        if is_own || is_full || !task.is_valid() || !context.may_grant() {
            return;
        }
        let (goal, now_s) = (task.id, context.now_s);
        let again_s = context.settings.owner_lease_s / 2.0;
        let mut all = self.lost.iter();
        let lost = all.find(|lost| lost.owned.task.id == goal);
        let sent = lost
            .and_then(|lost| lost.request)
            .filter(|sent| sent.backup == from && now_s < sent.sent_s + again_s);
        let request = sent.unwrap_or_else(|| {
            let number = context.numbers.draw();
            let leases = &mut context.ledger.leases;
            leases.request(number, from, Some(goal), now_s);
            Request {
                number,
                backup: from,
                sent_s: now_s,
            }
        });
        let mut all = self.lost.iter_mut();
        match all.find(|lost| lost.owned.task.id == goal) {
            Some(lost) => lost.request = Some(request),
            None => self.lost.push(Lost {
                owned: Owned::new(task, now_s, 0.0),
                request: Some(request),
            }),
        }
        send_binding(context, goal, from, request.number);
    }

    /// A backup has granted the ownership of a goal that it returns.
    fn take_back(&mut self, context: &mut Context, backup: AgentId, claim: Claim, lease_s: f64) {
        let (Claim { goal, number }, now_s) = (claim, context.now_s);
        let mut all = self.lost.iter();
        let index = all.position(|lost| {
            let is_answer = |it: Request| it.number == number && it.backup == backup;
            lost.owned.task.id == goal && lost.request.is_some_and(is_answer)
        });
        let Some(index) = index else {
            return;
        };
        if context.ledger.leases.accept(backup, claim, lease_s, now_s) {
            let Lost { mut owned, .. } = self.lost.remove(index);
            owned.offer_again(now_s);
            owned.handover = Handover::Bound {
                backup,
                number,
                is_confirmed: true,
                next_s: now_s,
            };
            context.ledger.goals.push(owned);
        }
    }

    /// Sends the next message about the handover of a goal; returns whether there was one to send.
    pub(super) fn hand_over(context: &mut Context, contracts: &Contracts, index: usize) -> bool {
        let now_s = context.now_s;
        let best = context.peers.highest();
        let owned = &mut context.ledger.goals[index];
        let (goal, task) = (owned.task.id, owned.task_at(now_s));
        let origin = owned.origin.filter(|origin| context.peers.is_near(*origin));
        let situation = Situation {
            now_s,
            is_done: owned.is_done,
            best,
            origin,
        };
        let Some(action) = owned.handover.step(&situation) else {
            return false;
        };
        match action {
            Action::Entrust(backup) => context.send(backup, OwnershipMessage::Entrust(task)),
            Action::Bind(backup, number) => bind(context, goal, backup, number),
            Action::Relieve(backup) => relieve(context, goal, backup),
            Action::Restore(origin) => {
                let is_free = contracts.is_free(goal);
                return offer_return(context, index, origin, is_free);
            }
        }
        true
    }

    /// The backup is relieved: the goal is owned without a lease, if the lease has not ended.
    pub(super) fn take_relieved(context: &mut Context, from: AgentId, claim: Claim) {
        let leases = &mut context.ledger.leases;
        let is_held = leases.is_held(claim.goal, context.now_s);
        if !leases.is_answer(from, claim) || !is_held {
            return;
        }
        leases.release(claim.goal);
        if let Some(owned) = context.ledger.get_mut(claim.goal) {
            owned.handover = Handover::Alone;
        }
    }
}

/// From now on, a goal is owned only under a lease. A backup that answered an earlier request before it received the binding
/// did not know that it would be bound: such an answer relieves it no more.
fn bind(context: &mut Context, goal: GoalId, backup: AgentId, number: u32) {
    context.ledger.leases.forget_requests(goal);
    let now_s = context.now_s;
    if let Some(owned) = context.ledger.get_mut(goal) {
        owned.handover.bind(backup, number, now_s);
    }
    send_binding(context, goal, backup, number);
}

fn send_binding(context: &mut Context, goal: GoalId, backup: AgentId, number: u32) {
    let lease_s = short(context.settings.service_lease_s);
    let binding = Award {
        goal,
        number,
        lease_s,
    };
    context.send(backup, OwnershipMessage::Bind(binding));
}

fn relieve(context: &mut Context, goal: GoalId, backup: AgentId) {
    let (number, now_s) = (context.numbers.draw(), context.now_s);
    let leases = &mut context.ledger.leases;
    leases.request(number, backup, Some(goal), now_s);
    context.send(backup, OwnershipMessage::Relieve(Claim { goal, number }));
}

/// A backup returns a goal that a person has issued here again meanwhile: it is to be the backup of that.
fn rejoin(context: &mut Context, backup: AgentId, goal: GoalId) {
    let next_s = context.now_s;
    let owned = context.ledger.get_mut(goal).filter(|owned| !owned.is_done);
    if let Some(owned) = owned.filter(|owned| owned.handover == Handover::Alone) {
        owned.handover = Handover::Offered { backup, next_s };
    }
}

/// Offers a goal that it has taken over to the controller that owned it, while no robot serves it.
fn offer_return(context: &mut Context, index: usize, origin: AgentId, is_free: bool) -> bool {
    let now_s = context.now_s;
    let owned = &mut context.ledger.goals[index];
    if !is_free || now_s < owned.next_return_s {
        return false;
    }
    owned.next_return_s = now_s + RETRY_S;
    let task = owned.task_at(now_s);
    context.send(origin, OwnershipMessage::Restore(task));
    true
}
