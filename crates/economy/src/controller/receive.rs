//! The effect of each message on a controller.

use super::{Controller, NO_BID};
use base::geometry::Point;
use brain::{
    About, AgentRole, Bid, Claim, Dispatch, Percept, Reason, ReceivedMessage, Refusal, Renewal,
};
use brain::{AgentId, GoalId, Report, Verdict};

/// A robot that refuses a goal is not called again for it for this time, in seconds, and as much for
/// each robot that is present, which is at least the time between two calls.
const DECLINED_S: f64 = 30.0;
const DECLINED_PER_ROBOT_S: f64 = 2.0;

/// Longest plausible time of a bid, in seconds: of its goal, and of all that the robot serves.
const MAX_TIME_S: f32 = 1e7;

impl Controller {
    pub(super) fn receive(&mut self, received: &ReceivedMessage, percept: &Percept) {
        let About::Dispatch(dispatch) = received.message.about else {
            return;
        };
        let from = received.from;
        match from.role {
            AgentRole::Robot => {
                self.receive_of_robot(from, dispatch, received.message.confidence);
            }
            AgentRole::Controller if from != self.own => {
                self.receive_of_controller(received, dispatch, percept);
            }
            AgentRole::Person => self.receive_of_person(dispatch),
            AgentRole::Controller => {}
        }
    }

    fn receive_of_person(&mut self, dispatch: Dispatch) {
        match dispatch {
            Dispatch::Issue(task) => self.take_issued(task),
            Dispatch::Acknowledge(goal) => self.reports.remove(goal),
            _ => {}
        }
    }

    fn receive_of_robot(&mut self, from: AgentId, dispatch: Dispatch, confidence: f64) {
        match dispatch {
            Dispatch::Report(report) => self.take_report(from, &report, confidence),
            Dispatch::Bid(bid) => self.take_bid(from, bid, confidence),
            Dispatch::Commit(claim) => self.take_commitment(from, claim),
            Dispatch::Refuse(refusal) => self.take_refusal(from, refusal),
            Dispatch::Done(claim) => self.take_done(from, claim),
            Dispatch::Stuck(refusal) => self.take_stuck(from, refusal),
            Dispatch::Fitness(fitness) => {
                self.note_progress(from, &fitness);
                if fitness.verdict == Verdict::Approaching {
                    self.is_approaching(from, fitness.goal, fitness.remaining_s.into());
                }
            }
            Dispatch::Release(claim) => self.take_release(from, claim),
            Dispatch::Renew(renewal) => self.renew_services(from, renewal),
            Dispatch::RenewOne(claim) => self.renew_service(from, claim),
            Dispatch::Coverage(_) | Dispatch::Mark(_) | Dispatch::Statement(_) => {
                self.clearing.receive(from, &dispatch);
            }
            _ => {}
        }
    }

    /// A robot that was not present is a reason to try goals again that no robot could serve.
    fn note_robot(&mut self, from: AgentId) {
        if self.picture.note(from, self.now_s) {
            let now_s = self.now_s;
            self.goals
                .iter_mut()
                .for_each(|owned| owned.try_again(now_s));
        }
    }

    fn take_report(&mut self, from: AgentId, report: &Report, confidence: f64) {
        self.note_robot(from);
        if report.payload == 0 {
            self.round.end(from);
        }
        self.picture.report(from, report, confidence, self.now_s);
    }

    /// A bid counts if its goal is on offer under the number of the bid. If it is not, the robot is to
    /// know that.
    fn take_bid(&mut self, from: AgentId, bid: Bid, confidence: f64) {
        let is_possible = confidence > 0.0 && confidence <= 1.0;
        let times_s = [bid.time_s, bid.total_s];
        if !is_possible
            || !times_s
                .iter()
                .all(|time_s| (0.0..=MAX_TIME_S).contains(time_s))
        {
            return;
        }
        self.note_robot(from);
        let now_s = self.now_s;
        let Some(owned) = self.goal_mut(bid.goal) else {
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
            self.send(from, Dispatch::Withdraw(claim));
        }
    }

    fn take_commitment(&mut self, from: AgentId, claim: Claim) {
        let Some(owned) = self.goal_mut(claim.goal) else {
            return;
        };
        let assigned = owned.assigned.as_mut();
        let own =
            assigned.filter(|assigned| assigned.robot == from && assigned.number == claim.number);
        if let Some(assigned) = own.filter(|assigned| !assigned.is_committed) {
            assigned.is_committed = true;
            self.round.committed(from);
            self.bids.remove_of(from);
            self.report_assignees(claim.goal);
        }
    }

    fn take_refusal(&mut self, from: AgentId, refusal: Refusal) {
        let Refusal {
            goal,
            number,
            reason,
        } = refusal;
        let now_s = self.now_s;
        self.round.end(from);
        if reason == Reason::Full {
            self.picture.is_full(from, now_s);
            self.displace(from, goal);
        }
        if reason == Reason::OutOfService {
            self.picture.is_gone(from, now_s);
        }
        let claim = Claim { goal, number };
        let was_awarded = self.services.release(from, claim).is_some();
        if was_awarded {
            if reason != Reason::OutOfService {
                self.note_failure(from, goal);
            }
            self.reopen(claim);
        }
        let is_unable = was_awarded || (reason != Reason::Lease && reason != Reason::Full);
        let until_s = self.declined_until_s();
        if let Some(owned) = self.goal_mut(goal).filter(|_| is_unable) {
            owned.decline(from, until_s, reason);
        }
    }

    /// A robot returns what it was awarded: its bids for it do not count for a time.
    fn note_failure(&mut self, from: AgentId, goal: GoalId) {
        let now_s = self.now_s;
        let owned = self.goal_mut(goal);
        let kept = owned.filter(|owned| !owned.assigned.is_some_and(|it| it.is_withdrawn));
        if let Some(owned) = kept {
            owned.lapses.add(from, now_s);
            self.picture.learn(from, false, now_s);
        }
    }

    fn declined_until_s(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "numbers of robots")]
        let robots = self.picture.present().count() as f64;
        self.now_s + DECLINED_S + DECLINED_PER_ROBOT_S * robots
    }

    fn take_release(&mut self, from: AgentId, claim: Claim) {
        if self.services.release(from, claim).is_some() {
            self.note_failure(from, claim.goal);
            self.reopen(claim);
            self.call_reserved(from);
        }
    }

    /// A goal is done if a robot to which it was awarded reports it. Of an inherited goal, the previous
    /// owner has reported its awards; a robot of which no such message arrived has served it in vain.
    fn take_done(&mut self, from: AgentId, claim: Claim) {
        let (now_s, until_s) = (self.now_s, self.declined_until_s());
        self.restore_orphan(from, claim.goal);
        let Some(owned) = self.goal_mut(claim.goal) else {
            return;
        };
        if !owned.is_done && !owned.assignees.contains(&from) {
            // It does not bid for what it has served.
            owned.decline(from, until_s, Reason::Lease);
            return;
        }
        if !owned.is_done {
            owned.is_done = true;
            owned.assigned = None;
            self.picture.learn(from, true, now_s);
            self.bids.remove_for(claim.goal);
            self.close_offer(claim.goal, NO_BID);
        }
        self.services.release(from, claim);
        self.services.withdraw(claim.goal);
        self.send(from, Dispatch::Withdraw(claim));
    }

    fn renew_services(&mut self, from: AgentId, renewal: Renewal) {
        self.note_robot(from);
        let answer = if self.services.renew(from, renewal, self.now_s) {
            Dispatch::Renewed(renewal.number)
        } else {
            Dispatch::Differs(renewal.number)
        };
        self.send(from, answer);
    }

    /// A lease that the robot does not have, or is to release, is withdrawn.
    fn renew_service(&mut self, from: AgentId, claim: Claim) {
        let answer = if self.services.renew_one(from, claim, self.now_s) {
            Dispatch::RenewedOne(claim)
        } else if self.goals.iter().any(|owned| owned.task.id == claim.goal) {
            Dispatch::Withdraw(claim)
        } else {
            return;
        };
        self.send(from, answer);
    }

    fn receive_of_controller(
        &mut self,
        received: &ReceivedMessage,
        dispatch: Dispatch,
        percept: &Percept,
    ) {
        let from = received.from;
        match dispatch {
            Dispatch::Serial(serial) => self.colleagues.note(from, serial, self.now_s),
            Dispatch::LaneGain(gain) => self.colleagues.note_lane_gain(from, gain.into()),
            Dispatch::Seen(seen) => {
                let at = Point::from(seen.at_m.map(f64::from));
                self.picture
                    .see(seen.robot, at, received.message.confidence, self.now_s);
            }
            Dispatch::Entrust(task) => self.take_entrusted(from, task, percept),
            Dispatch::Entrusted(answer) => self.take_answer(from, answer),
            Dispatch::Assigned(assignment) => self.take_assignment(from, assignment),
            Dispatch::Bind(binding) => self.take_binding(from, binding),
            Dispatch::Renew(renewal) => self.renew_estates(from, renewal),
            Dispatch::RenewOne(claim) => self.renew_estate(from, claim),
            Dispatch::Renewed(number) => self.tenures.renew(from, number, self.now_s),
            Dispatch::RenewedOne(claim) => self.tenures.renew_one(from, claim, self.now_s),
            Dispatch::Differs(number) => self.renew_tenures_one_by_one(from, number, percept),
            Dispatch::Relieve(claim) => self.take_relief(from, claim),
            Dispatch::Relieved(claim) => self.take_relieved(from, claim),
            Dispatch::Restore(task) => self.take_return(from, task, percept),
            _ => {}
        }
    }
}
