//! The owner's half: it requests votes for its goals, owns them while a majority votes for it, and reports what it loses.

use super::kept::Kept;
use super::{MAX_LEASE_S, MAX_MESSAGES, Ownership};
use crate::controller::context::{Context, short};
use crate::controller::contracts::Contracts;
use crate::controller::handover::{CANDIDACY_S, RETRY_S, Role};
use crate::controller::ledger::owned::Owned;
use alloc::vec::Vec;
use brain::{
    AgentId, Award, Claim, Entrust, GoalId, OwnershipMessage, Reason, Refusal, Task, TradeMessage,
};

impl Ownership {
    /// A goal that a person has issued: it is to own it, unless it votes for an owner.
    pub(crate) fn take_issued(&mut self, context: &mut Context, task: Task) {
        context.ledger.reports.remove(task.id);
        let now_s = context.now_s;
        let is_granted = self.granted.grant_of(task.id).is_some();
        if let Some(kept) = self.kept_mut(task.id) {
            kept.is_reported = false;
            if !is_granted {
                kept.turn_s = now_s;
            }
            return;
        }
        if let Err(reason) = context.own(task) {
            context.ledger.refused += 1;
            let refusal = Refusal {
                goal: task.id,
                number: 0,
                reason,
            };
            context.ledger.reports.put_refused(refusal, context.now_s);
        }
    }

    /// Another controller votes for this one.
    pub(super) fn take_vote(context: &mut Context, from: AgentId, vote: Award) {
        let Award {
            goal,
            number,
            lease_s,
        } = vote;
        let min_lease_s = short(context.settings.min_owner_lease_s());
        let is_open = context.ledger.has_undone(goal);
        if !is_open || !(min_lease_s..=MAX_LEASE_S).contains(&lease_s) {
            return;
        }
        let (now_s, claim) = (context.now_s, Claim { goal, number });
        let leases = context.ledger.leases_of(from);
        if !leases.accept(from, claim, lease_s.into(), now_s) {
            return;
        }
        if let Some(owned) = context.ledger.get_mut(goal) {
            let is_giver = owned.giver == Some(from);
            owned.vote_of(from, now_s).next_s = if is_giver { now_s } else { f64::INFINITY };
        }
        context.count_votes_for(goal);
        context.report_assignees(goal);
    }

    /// A voter knows that a goal has been served.
    pub(super) fn take_note(context: &mut Context, from: AgentId, goal: GoalId) {
        let now_s = context.now_s;
        let owned = context.ledger.get_mut(goal);
        if let Some(owned) = owned.filter(|owned| owned.is_done) {
            owned.vote_of(from, now_s).next_s = f64::INFINITY;
            context.ledger.leases_of(from).release(goal);
        }
    }

    /// A robot reports that it has served a goal that the controller does not own any more: it has been served.
    pub(crate) fn restore_done(&mut self, context: &mut Context, from: AgentId, goal: GoalId) {
        let mut all = self.kept.iter();
        let index = all.position(|kept| kept.task.id == goal && kept.assignees.contains(&from));
        if let Some(index) = index {
            let kept = self.kept.remove(index);
            let mut owned = Owned::new(kept.task, context.now_s, f64::INFINITY);
            (owned.assignees, owned.is_done) = (kept.assignees, true);
            context.ledger.goals.push(owned);
        }
    }

    /// Leases end: the votes are to be requested again.
    pub(super) fn expire_votes(context: &mut Context) {
        let now_s = context.now_s;
        let mut has_ended = false;
        for index in 0..context.ledger.voters.len() {
            let voter = &mut context.ledger.voters[index];
            let from = voter.id;
            for goal in voter.leases.expire(now_s) {
                has_ended = true;
                if let Some(owned) = context.ledger.get_mut(goal) {
                    let vote = owned.vote_of(from, now_s);
                    (vote.next_s, vote.requested_s) = (now_s, f64::NEG_INFINITY);
                }
            }
        }
        if has_ended {
            context.count_votes();
        }
    }

    /// Candidates become owners, and both give up, as the votes are.
    pub(crate) fn settle(&mut self, context: &mut Context, contracts: &mut Contracts) {
        let (now_s, wait_s) = (context.now_s, context.takeover_wait_s());
        let mut given_up = Vec::new();
        for owned in context.ledger.goals.iter_mut().filter(|it| !it.is_done) {
            let has_majority = now_s < owned.held_until_s;
            match owned.role {
                Role::Candidate { free_until_s, .. } if has_majority => {
                    let is_free = now_s < free_until_s;
                    owned.win(now_s, if is_free { 0.0 } else { wait_s });
                }
                Role::Candidate { since_s, .. } if now_s >= since_s + CANDIDACY_S => {
                    given_up.push(owned.task.id);
                }
                Role::Owner if !has_majority => given_up.push(owned.task.id),
                Role::Candidate { .. } | Role::Owner => {}
            }
        }
        for goal in given_up {
            self.give_up(context, contracts, goal);
        }
    }

    /// No majority votes for it: that is reported, and it is a candidate again later.
    fn give_up(&mut self, context: &mut Context, contracts: &mut Contracts, goal: GoalId) {
        let Some(owned) = context.ledger.get(goal) else {
            return;
        };
        let (was_owner, is_reported, giver) =
            (owned.role == Role::Owner, owned.is_reported, owned.giver);
        // The controller that has transferred it to this one in vain keeps it.
        let is_of_giver = owned.is_of_transfer();
        self.keep(context, contracts, goal);
        if is_of_giver && giver.is_some() {
            self.kept.retain(|kept| kept.task.id != goal);
            return;
        }
        if !is_of_giver && (was_owner || !is_reported) {
            context.report(goal, 0, Reason::OwnershipLost);
        }
        let turn_s = context.now_s + CANDIDACY_S;
        if let Some(kept) = self.kept_mut(goal) {
            (kept.is_reported, kept.turn_s) = (!is_of_giver, turn_s);
        }
    }

    /// It is the owner of a goal, or a candidate for it, no longer, and keeps its description.
    pub(super) fn keep(&mut self, context: &mut Context, contracts: &mut Contracts, goal: GoalId) {
        for (voter, claim) in context.ledger.release(goal) {
            context.send(voter, OwnershipMessage::Release(claim));
        }
        let goals = &mut context.ledger.goals;
        let index = goals.iter().position(|owned| owned.task.id == goal);
        let Some(owned) = index.map(|index| goals.remove(index)) else {
            return;
        };
        let mut kept = Kept::new(owned.task, owned.due_at_s, context.own);
        (kept.assignees, kept.is_reported) = (owned.assignees, owned.is_reported);
        (kept.giver, kept.limit_s) = (owned.giver, owned.limit_s);
        self.kept.push(kept);
        contracts.forget(goal);
    }

    /// Requests the votes that are missing, of goals without a majority first, and informs voters of goals that have been
    /// served. The time of a candidate counts from its first request.
    pub(super) fn request_votes(context: &mut Context) {
        if !context.may_grant() {
            return;
        }
        let members: Vec<AgentId> = context.peers.members_of(context.own).collect();
        let mut left = MAX_MESSAGES;
        for is_held in [false, true] {
            for index in 0..context.ledger.goals.len() {
                if context.ledger.goals[index].is_held(context.now_s) == is_held {
                    request_votes_for(context, index, &members, &mut left);
                }
            }
        }
    }
}

fn request_votes_for(context: &mut Context, index: usize, members: &[AgentId], left: &mut usize) {
    let now_s = context.now_s;
    let is_alone = context.votes_needed() == 0;
    for member in members {
        let owned = &mut context.ledger.goals[index];
        if is_alone && !owned.is_traded_with(*member) {
            continue;
        }
        if *left > 0 {
            *left -= usize::from(request_vote(context, index, *member));
        } else if let Role::Candidate { since_s, .. } = &mut owned.role
            && owned.votes.is_empty()
        {
            *since_s = now_s;
        }
    }
}

/// Sends the message about a goal that is due to a member, if any is.
fn request_vote(context: &mut Context, index: usize, member: AgentId) -> bool {
    let now_s = context.now_s;
    let owned = &mut context.ledger.goals[index];
    let vote = owned.vote_of(member, now_s);
    if now_s < vote.next_s {
        return false;
    }
    vote.next_s = now_s + RETRY_S;
    let (number, requested_s) = (vote.number, vote.requested_s);
    let goal = owned.task.id;
    if owned.is_done {
        context.send(member, OwnershipMessage::Ended(goal));
    } else if owned.giver == Some(member) && owned.is_held(now_s) {
        context.send(member, TradeMessage::Dismiss(Claim { goal, number }));
    } else {
        let task = owned.task_at(now_s);
        // A repeated request has the same number: the answer to any of them counts, from the first.
        let is_new = now_s >= requested_s + context.settings.owner_lease_s / 2.0;
        let number = if is_new {
            draw_request(context, index, member)
        } else {
            number
        };
        context.send(member, OwnershipMessage::Entrust(Entrust { number, task }));
    }
    true
}

/// The number of a new request for the vote of a member.
fn draw_request(context: &mut Context, index: usize, member: AgentId) -> u32 {
    let (number, now_s) = (context.numbers.draw(), context.now_s);
    let owned = &mut context.ledger.goals[index];
    let goal = owned.task.id;
    let vote = owned.vote_of(member, now_s);
    (vote.number, vote.requested_s) = (number, now_s);
    let leases = context.ledger.leases_of(member);
    leases.request(number, member, Some(goal), now_s);
    number
}
