//! The effect of each message of a robot on the contracts.

use super::Contracts;
use super::displacement::{call_reserved, note_progress};
use crate::controller::context::Context;
use brain::{
    About, AgentId, Bid, Claim, ContractMessage, GoalId, LeaseMessage, Reason, Refusal, Renewal,
    Report, Verdict,
};

/// A robot that refuses a goal is not called again for it for this time, in seconds, and as much for
/// each robot that is present, which is at least the time between two calls.
const DECLINED_S: f64 = 30.0;
const DECLINED_PER_ROBOT_S: f64 = 2.0;

/// Longest plausible time of a bid, in seconds: of its goal, and of all that the robot serves.
const MAX_TIME_S: f32 = 1e7;

impl Contracts {
    pub(crate) fn receive(
        &mut self,
        context: &mut Context,
        from: AgentId,
        message: ContractMessage,
        confidence: f64,
    ) {
        match message {
            ContractMessage::Report(report) => self.take_report(context, from, &report, confidence),
            ContractMessage::Bid(bid) => self.take_bid(context, from, bid, confidence),
            ContractMessage::Commit(claim) => self.take_commitment(context, from, claim),
            ContractMessage::Refuse(refusal) => self.take_refusal(context, from, refusal),
            ContractMessage::Done(claim) => self.take_done(context, from, claim),
            ContractMessage::Stuck(refusal) => self.take_stuck(context, from, refusal),
            ContractMessage::Fitness(fitness) => {
                note_progress(context, from, &fitness);
                if fitness.verdict == Verdict::Approaching {
                    self.is_approaching(context, from, fitness.goal, fitness.remaining_s.into());
                }
            }
            ContractMessage::Release(claim) => self.take_release(context, from, claim),
            _ => {}
        }
    }

    /// Takes a message of a robot about its service leases.
    pub(crate) fn renew(&mut self, context: &mut Context, from: AgentId, message: LeaseMessage) {
        match message {
            LeaseMessage::Renew(renewal) => self.renew_services(context, from, renewal),
            LeaseMessage::RenewOne(claim) => self.renew_service(context, from, claim),
            _ => {}
        }
    }

    fn take_report(
        &mut self,
        context: &mut Context,
        from: AgentId,
        report: &Report,
        confidence: f64,
    ) {
        note_robot(context, from);
        if report.payload == 0 {
            self.round.end(from);
        }
        context
            .robots
            .report(from, report, confidence, context.now_s);
    }

    /// A bid counts if its goal is on offer under the number of the bid. If it is not, the robot is to
    /// know that.
    fn take_bid(&mut self, context: &mut Context, from: AgentId, bid: Bid, confidence: f64) {
        if !is_plausible(&bid, confidence) {
            return;
        }
        note_robot(context, from);
        let now_s = context.now_s;
        let Some(owned) = context.ledger.get_mut(bid.goal) else {
            return;
        };
        let is_own = owned
            .assigned
            .is_some_and(|assigned| assigned.robot == from);
        if !owned.lapses.may_bid(from, now_s) {
            return;
        }
        if owned.is_on_offer(now_s) && bid.call == owned.call && !is_own {
            owned.without_bid_s = now_s;
            self.round.has_bid(from);
            self.bids.put(from, bid, confidence, now_s);
        } else if !is_own {
            let claim = Claim {
                goal: bid.goal,
                number: bid.number,
            };
            context.send(from, ContractMessage::Withdraw(claim));
        }
    }

    fn take_commitment(&mut self, context: &mut Context, from: AgentId, claim: Claim) {
        let Some(owned) = context.ledger.get_mut(claim.goal) else {
            return;
        };
        let assigned = owned.assigned.as_mut();
        let own =
            assigned.filter(|assigned| assigned.robot == from && assigned.number == claim.number);
        if let Some(assigned) = own.filter(|assigned| !assigned.is_committed) {
            assigned.is_committed = true;
            self.round.committed(from);
            self.bids.remove_of(from);
            context.report_assignees(claim.goal);
        }
    }

    fn take_refusal(&mut self, context: &mut Context, from: AgentId, refusal: Refusal) {
        let Refusal {
            goal,
            number,
            reason,
        } = refusal;
        let now_s = context.now_s;
        self.round.end(from);
        if reason == Reason::Full {
            context.robots.is_full(from, now_s);
            self.displace(context, from, goal);
        }
        if reason == Reason::OutOfService {
            context.robots.is_gone(from, now_s);
        }
        let claim = Claim { goal, number };
        let was_awarded = self.services.release(from, claim).is_some();
        if was_awarded {
            if reason != Reason::OutOfService {
                note_failure(context, from, goal);
            }
            self.reopen(context, claim.goal);
        }
        let is_unable = was_awarded || (reason != Reason::Lease && reason != Reason::Full);
        let until_s = declined_until_s(context);
        if let Some(owned) = context.ledger.get_mut(goal).filter(|_| is_unable) {
            owned.decline(from, until_s, reason);
        }
    }

    fn take_release(&mut self, context: &mut Context, from: AgentId, claim: Claim) {
        if self.services.release(from, claim).is_some() {
            note_failure(context, from, claim.goal);
            self.reopen(context, claim.goal);
            call_reserved(context, from);
        }
    }

    /// A goal is done if a robot to which it was awarded reports it. Of a goal that it has taken over, the previous
    /// owner has reported its awards; a robot of which no such message arrived has served it in vain.
    fn take_done(&mut self, context: &mut Context, from: AgentId, claim: Claim) {
        let (now_s, until_s) = (context.now_s, declined_until_s(context));
        let Some(owned) = context.ledger.get_mut(claim.goal) else {
            return;
        };
        if !owned.is_done && !owned.assignees.contains(&from) {
            // It does not bid for what it has served.
            owned.decline(from, until_s, Reason::Lease);
            return;
        }
        if !owned.is_done {
            owned.finish(now_s);
            context.robots.learn(from, true, now_s);
            self.bids.remove_for(claim.goal);
            context.close_offer(claim.goal, None);
        }
        self.services.release(from, claim);
        self.services.withdraw(claim.goal);
        context.send(from, ContractMessage::Withdraw(claim));
    }

    fn renew_services(&mut self, context: &mut Context, from: AgentId, renewal: Renewal) {
        note_robot(context, from);
        let now_s = context.now_s;
        let mut own = self.services.grants().iter();
        let is_owner = own.all(|it| {
            it.holder != from || it.is_withdrawn || context.ledger.owns_at(it.goal, now_s)
        });
        let answer = if is_owner && self.services.renew(from, renewal, now_s) {
            LeaseMessage::Renewed(renewal.number)
        } else {
            LeaseMessage::Differs(renewal.number)
        };
        context.send(from, answer);
    }

    /// A lease that the robot does not have, or is to release, is withdrawn. A candidate does not know whether it is to.
    fn renew_service(&mut self, context: &mut Context, from: AgentId, claim: Claim) {
        let now_s = context.now_s;
        let is_owner = context.ledger.owns_at(claim.goal, now_s);
        let answer = if is_owner && self.services.renew_one(from, claim, now_s) {
            About::from(LeaseMessage::RenewedOne(claim))
        } else if is_owner || context.ledger.get(claim.goal).is_some_and(|it| it.is_done) {
            ContractMessage::Withdraw(claim).into()
        } else {
            return;
        };
        context.send(from, answer);
    }
}

/// Whether the numbers of a bid are possible.
pub(crate) fn is_plausible(bid: &Bid, confidence: f64) -> bool {
    let mut times_s = [bid.time_s, bid.total_s].into_iter();
    let is_possible = confidence > 0.0 && confidence <= 1.0;
    is_possible && times_s.all(|time_s| (0.0..=MAX_TIME_S).contains(&time_s))
}

/// A robot that was not present is a reason to try goals again that no robot could serve.
fn note_robot(context: &mut Context, from: AgentId) {
    let now_s = context.now_s;
    if context.robots.note(from, now_s) {
        let goals = context.ledger.goals.iter_mut();
        goals.for_each(|owned| owned.try_again(now_s));
    }
}

/// Until when a robot that refuses a goal now is not called again for it.
fn declined_until_s(context: &Context) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "numbers of robots")]
    let robots = context.robots.present().count() as f64;
    context.now_s + DECLINED_S + DECLINED_PER_ROBOT_S * robots
}

/// A robot returns what it was awarded: its bids for it do not count for a time.
fn note_failure(context: &mut Context, from: AgentId, goal: GoalId) {
    let now_s = context.now_s;
    let owned = context.ledger.get_mut(goal);
    let kept = owned.filter(|owned| !owned.assigned.is_some_and(|it| it.is_withdrawn));
    if let Some(owned) = kept {
        owned.lapses.add(from, now_s);
        context.robots.learn(from, false, now_s);
    }
}
