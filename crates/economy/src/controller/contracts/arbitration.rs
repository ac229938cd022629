//! Whether a robot keeps a goal, or another gets it.
//!
//! ```text
//! A robot keeps its goal while it approaches it. A goal is contested when its robot reports that it
//! is stuck, or is overdue: other robots can bid for it, and the first valid bid moves it. If there is
//! none, the robot keeps it and tries again; if it approaches again, the contest ends. A robot that
//! stays stuck for half a minute without another bid loses it: it is reported, and offered again later.
//! A robot that refuses, releases or is silent until its lease ends has lost the goal at once. A goal that all robots
//! lose again and again rests, and is reported.
//! A goal that waits because all robots are full displaces a goal of at most half its value whose
//! service has not begun.
//! ```
//!
//! A goal never moves back and forth: a robot that has lost it rests before it bids again, each time
//! for twice as long, with half the confidence, and no goal is contested only because another robot
//! would be nearer. New goals that lie better change the order in which robots serve theirs.

use super::Contracts;
use super::unserved::give_up;
use crate::controller::context::Context;
use crate::controller::ledger::owned::Assigned;
use alloc::vec::Vec;
use brain::{AgentId, Claim, ContractMessage, GoalId, Reason, Refusal};

/// A withdrawal without an answer is repeated after this time, in seconds.
const RETRY_S: f64 = 1.0;

/// The time in which a robot that approaches again is expected to serve its goal, as a multiple of what
/// it reports, and the time that is added, in seconds.
const OVERDUE_FACTOR: f64 = 4.0;
const OVERDUE_S: f64 = 60.0;

/// A goal rests, and is reported, when robots have lost it this many times for each robot that is present.
const FAILURES_PER_ROBOT: usize = 2;

/// A robot that is stuck keeps its goal for this time without a bid of another, in seconds.
const HOPELESS_S: f64 = 30.0;

impl Contracts {
    /// A robot does not reach its goal: others can have it.
    pub(super) fn take_stuck(&mut self, context: &mut Context, from: AgentId, refusal: Refusal) {
        let now_s = context.now_s;
        let is_holder = |holder: AgentId| holder == from;
        let grant = self.services.grant_of(refusal.goal);
        if grant.is_some_and(|grant| is_holder(grant.holder)) {
            self.contest(context, refusal.goal);
            let owned = context.ledger.get_mut(refusal.goal);
            if let Some(assigned) = owned.and_then(|owned| owned.assigned.as_mut()) {
                assigned.stuck_s = assigned.stuck_s.min(now_s);
            }
        }
        if let Some(owned) = context.ledger.get_mut(refusal.goal) {
            owned.reason = refusal.reason;
        }
    }

    /// A robot approaches its goal again, or reports how long it will take.
    pub(super) fn is_approaching(
        &mut self,
        context: &mut Context,
        from: AgentId,
        goal: GoalId,
        remaining_s: f64,
    ) {
        let now_s = context.now_s;
        let Some(owned) = context.ledger.get_mut(goal) else {
            return;
        };
        let assigned = owned
            .assigned
            .as_mut()
            .filter(|assigned| assigned.robot == from);
        let Some(assigned) = assigned.filter(|assigned| !assigned.is_withdrawn) else {
            return;
        };
        let is_late = now_s >= assigned.overdue_s;
        assigned.stuck_s = f64::INFINITY;
        if assigned.is_contested && !is_late {
            assigned.is_contested = false;
            assigned.overdue_s = now_s + OVERDUE_S + OVERDUE_FACTOR * remaining_s.clamp(0.0, 1e4);
            self.bids.remove_for(goal);
            context.close_offer(goal, None);
        }
    }

    /// Contests overdue goals, and moves contested ones for which another robot has bid.
    pub(super) fn arbitrate(&mut self, context: &mut Context) {
        let now_s = context.now_s;
        let assigned = context.ledger.goals.iter().filter_map(|owned| {
            let assigned = owned.assigned?;
            Some((owned.task.id, assigned))
        });
        let assigned: Vec<_> = assigned.collect();
        for (goal, assigned) in assigned {
            if assigned.is_withdrawn {
                self.withdraw(context, goal);
            } else if assigned.is_contested {
                if self.has_other_bid(goal, assigned.robot) {
                    context.robots.learn(assigned.robot, false, now_s);
                    self.withdraw(context, goal);
                } else {
                    self.withdraw_if_hopeless(context, goal, assigned);
                }
            } else if now_s >= assigned.overdue_s {
                self.contest(context, goal);
            }
        }
    }

    fn contest(&mut self, context: &mut Context, goal: GoalId) {
        let now_s = context.now_s;
        let Some(owned) = context.ledger.get_mut(goal) else {
            return;
        };
        if let Some(assigned) = owned
            .assigned
            .as_mut()
            .filter(|assigned| !assigned.is_contested)
        {
            assigned.is_contested = true;
            owned.offer_again(now_s);
            self.bids.remove_for(goal);
        }
    }

    /// A robot is stuck, and no other has bid for its goal for a time.
    fn withdraw_if_hopeless(&mut self, context: &mut Context, goal: GoalId, assigned: Assigned) {
        let now_s = context.now_s;
        let Some(owned) = context.ledger.get_mut(goal) else {
            return;
        };
        let since_s = owned.without_bid_s.max(assigned.stuck_s);
        if now_s >= since_s + HOPELESS_S {
            let is_stuck = assigned.stuck_s.is_finite();
            let reason = if is_stuck {
                owned.reason
            } else {
                Reason::Unreachable
            };
            owned.decline(assigned.robot, now_s + HOPELESS_S, reason);
            self.withdraw(context, goal);
        }
    }

    fn has_other_bid(&self, goal: GoalId, robot: AgentId) -> bool {
        let mut bids = self.bids.iter();
        bids.any(|standing| standing.bid.goal == goal && standing.robot != robot)
    }

    /// The robot is to release the goal; until it does, its lease is not renewed.
    pub(super) fn withdraw(&mut self, context: &mut Context, goal: GoalId) {
        let now_s = context.now_s;
        let Some(owned) = context.ledger.get_mut(goal) else {
            return;
        };
        let Some(assigned) = owned.assigned.as_mut() else {
            return;
        };
        if assigned.is_withdrawn && now_s < assigned.next_s {
            return;
        }
        (assigned.is_withdrawn, assigned.next_s) = (true, now_s + RETRY_S);
        let robot = assigned.robot;
        self.services.withdraw(goal);
        if let Some(grant) = self.services.grant_of(goal).copied() {
            let number = grant.number;
            context.send(robot, ContractMessage::Withdraw(Claim { goal, number }));
        }
    }

    /// A lease has ended by message: the goal is offered again, unless it already is.
    pub(super) fn reopen(&mut self, context: &mut Context, goal: GoalId) {
        let now_s = context.now_s;
        let Some(owned) = context.ledger.get_mut(goal) else {
            return;
        };
        owned.failures = owned.failures.saturating_add(1);
        if owned.is_done {
            return;
        }
        let was_contested = owned
            .assigned
            .take()
            .is_some_and(|assigned| assigned.is_contested);
        let (failures, reason) = (owned.failures, owned.reason);
        if !was_contested {
            owned.offer_again(now_s);
            self.bids.remove_for(goal);
        }
        let tries = FAILURES_PER_ROBOT * context.robots.present().count().max(1);
        if usize::from(failures).is_multiple_of(tries) {
            give_up(context, goal, reason);
        }
    }

    /// A lease has ended in silence.
    pub(super) fn lost_assignee(&mut self, context: &mut Context, goal: GoalId, robot: AgentId) {
        let now_s = context.now_s;
        if let Some(owned) = context.ledger.get_mut(goal).filter(|owned| !owned.is_done) {
            owned.lapses.add(robot, now_s);
            self.lapses += 1;
            context.robots.learn(robot, false, context.now_s);
            self.reopen(context, goal);
        }
    }
}
