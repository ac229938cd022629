//! The robot's half of the protocol: it bids for goals, serves those that it is awarded while it
//! holds their leases, and reports.

use super::ability::{Ability, Moment};
use super::charge_state::{Fence, Firing};
use super::failures::Failures;
use super::finished::Finished;
use super::holder::{Holder, Lease};
use super::jobs::{Job, Jobs};
use super::lane_reports::{Interrogation, LANE_REPORT_PERIOD_S, LaneReports};
use super::numbers::Numbers;
use super::offers::{NO_CALL, Offer, Offers};
use super::operator_reports::OperatorReports;
use super::schedule::Schedule;
use crate::goals::fitness::IMPOSSIBLE_S;
use crate::io::act::Act;
use crate::io::agent_id::{AgentId, AgentRole, Receiver};
use crate::io::command::Command;
use crate::io::contract::{Award, ContractMessage, Refusal};
use crate::io::goal_id::GoalId;
use crate::io::lease::{Claim, LeaseMessage};
use crate::io::message::{About, Message};
use crate::io::percept::ReceivedMessage;
use crate::io::reason::Reason;
use crate::io::verdict::Verdict;
use crate::io::work::lane::LaneMessage;
use crate::io::work::{Task, Work};
use crate::messaging::phase::phase;
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::pose::Pose;
use alloc::vec::Vec;
use base::geometry::{Point, Rectangle};
use base::hashed::Hashed;

/// A robot as the assignee of goals.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Assignee {
    /// The robot's clock.
    pub(crate) now_s: f64,
    pub(super) numbers: Numbers,
    pub(crate) holder: Holder,
    pub(crate) jobs: Jobs,
    pub(super) offers: Offers,
    pub(super) failures: Failures,
    pub(crate) finished: Finished,
    /// Goals that it serves no longer although it has not served them: their owner may be lost.
    pub(crate) returned: OperatorReports,
    pub(super) schedule: Schedule,
    /// Whether a person has taken it out of service.
    pub(super) is_out_of_service: bool,
    /// The goal that it proposed last.
    pub(super) proposed: Option<GoalId>,
    pub(super) lane: LaneReports,
    /// The goal of this step in which it has interrogated a mark, and whether it has fenced the item off.
    #[hashed(skip)]
    interrogated: Option<(Task, bool)>,
    pub(super) firing: Firing,
    #[hashed(skip)]
    pub(super) outbox: Vec<Message>,
    #[hashed(skip)]
    pub(super) acts: Vec<Act>,
}

impl Assignee {
    /// Takes a step: messages first, then the work, then what is due.
    pub(crate) fn step(&mut self, ability: &Ability, moment: &Moment) {
        self.outbox.clear();
        self.acts.clear();
        self.numbers.step(moment.percept);
        self.interrogated = None;
        self.proposed = self.proposed.filter(|goal| self.serves(*goal));
        self.now_s = moment
            .percept
            .time_s
            .unwrap_or(self.now_s + moment.elapsed_s);
        self.schedule.advance(self.now_s);
        self.offers.expire(self.now_s);
        self.stop_before_end(moment);
        self.take_results(moment);
        self.aim(ability, moment);
        self.return_goals(ability, moment);
        let inbox = &moment.percept.inbox;
        if inbox.iter().filter(|received| is_award(received)).count() > 1 {
            for received in self.in_order(ability, moment) {
                self.receive(received, ability, moment);
            }
        } else {
            for received in inbox {
                self.receive(received, ability, moment);
            }
        }
        self.work(ability, moment);
        self.bid(ability, moment);
        self.renew();
        self.report(ability, moment);
    }

    /// Reports what it has searched and detected in a lane that a controller has named, and its
    /// verdicts on the marks that it has interrogated.
    pub(crate) fn report_lane(&mut self, ability: &Ability, moment: &Moment, beliefs: &Beliefs) {
        let inbox = moment.percept.inbox.iter();
        for received in inbox.filter(|received| received.from.is_controller()) {
            if let About::Lane(LaneMessage::Lane(lane)) = received.message.about {
                let phase = phase(
                    moment.percept.id,
                    [LANE_REPORT_PERIOD_S, moment.body.period_s],
                );
                self.lane.name((lane, phase), beliefs, self.now_s);
            }
        }
        if let Some((task, is_isolated)) = self.interrogated.take() {
            let looked = Interrogation {
                within_m: ability.uncertain_m(&task),
                task,
                is_isolated,
            };
            self.lane.state(&looked, moment.body, beliefs);
        }
        for message in self.lane.step(moment, beliefs, self.now_s) {
            match message {
                LaneMessage::Statement(_) => self.send(Receiver::All, message),
                // Broadcast, these would be most of the messages that other robots receive.
                _ => self.send_to_controllers(message),
            }
        }
        self.lane.act(&mut self.acts);
    }

    /// The area of the lane that a controller has named.
    pub(crate) fn lane_area(&self) -> Option<Rectangle> {
        self.lane.area()
    }

    /// Adds the messages of this step to those of the robot, the most urgent ones first, and its acts.
    pub(crate) fn publish(&mut self, command: &mut Command) {
        command.outbox.append(&mut self.outbox);
        command.outbox.sort_by_key(Message::urgency);
        command.acts.append(&mut self.acts);
    }

    /// The goal to serve now, and whether the robot is there.
    pub(crate) fn current(&mut self, ability: &Ability, pose: &Pose) -> Option<(Job, bool)> {
        let goal = self.jobs.current(self.now_s)?.task.id;
        self.proposed = Some(goal);
        let job = self.jobs.get_mut(goal)?;
        // Until it is judged otherwise in this step.
        job.verdict = Verdict::Approaching;
        let seems_there = is_near(job, ability, pose.at, 0.0);
        job.is_uncertain |= seems_there && !is_certain(job, pose.deviation_m);
        let is_there = is_there(job, ability, pose.at, pose.deviation_m);
        let waits = job.waited_s > 0.0 && !is_certain(job, pose.deviation_m);
        Some((*job, waits || is_there && job.is_swept(ability)))
    }

    /// Whether it serves a goal.
    pub(crate) fn serves(&self, goal: GoalId) -> bool {
        self.jobs.get(goal).is_some()
    }

    /// Whether it has served a goal that it proposed in the last step; `None` for goals of other behaviours.
    pub(crate) fn has_served(&self, goal: GoalId) -> Option<bool> {
        let is_done = self.finished.contains(goal);
        (is_done || self.serves(goal) || self.proposed == Some(goal)).then_some(is_done)
    }

    /// Takes the verdict on the goal that it proposed last.
    pub(crate) fn judged(&mut self, ability: &Ability, verdict: Verdict) {
        let Some(job) = self.proposed.and_then(|goal| self.jobs.get_mut(goal)) else {
            return;
        };
        if verdict == Verdict::Impossible && job.skip_corner(ability) {
            return;
        }
        job.verdict = verdict;
        if verdict == Verdict::Impossible {
            let goal = job.task.id;
            let reason = if job.is_uncertain {
                Reason::Position
            } else {
                Reason::Unreachable
            };
            self.fail(goal, reason);
        }
    }

    /// A goal is impossible at present: others are served first, and its owner is to know.
    fn fail(&mut self, goal: GoalId, reason: Reason) {
        if let Some(job) = self.jobs.get_mut(goal) {
            job.rests_until_s = self.failures.add(goal, reason, self.now_s);
        }
        self.report_failure(goal, reason);
    }

    /// Changes the ids of other agents; those without a new id are forgotten.
    pub(crate) fn renumber(&mut self, new_id: &impl Fn(AgentId) -> Option<AgentId>) {
        // Leases and offers name their owners: after a change of ids, they are obtained again.
        let is_unchanged = |id: AgentId| new_id(id) == Some(id);
        let others = self.jobs.list.iter().filter(|job| !is_unchanged(job.owner));
        let others: Vec<GoalId> = others.map(|job| job.task.id).collect();
        for goal in others {
            self.drop_job(goal, Reason::Lease);
        }
        self.schedule
            .contacts
            .retain(|contact| is_unchanged(contact.id));
    }

    pub(super) fn send(&mut self, to: impl Into<Receiver>, about: impl Into<About>) {
        self.outbox.push(Message::to(to, about));
    }

    fn send_to_controllers(&mut self, about: impl Into<About>) {
        let about = about.into();
        let each = self.schedule.contacts.iter();
        let messages = each.map(|contact| Message::to(contact.id, about));
        self.outbox.extend(messages);
    }

    /// Drops the goals whose lease ends before the next step.
    fn stop_before_end(&mut self, moment: &Moment) {
        let step_s = moment.body.period_s.max(moment.elapsed_s.min(1.0));
        for goal in self.holder.expire(self.now_s + step_s) {
            self.drop_job(goal, Reason::Lease);
        }
    }

    /// Returns a goal whose deadline has passed, or for which the battery does not last.
    fn return_goals(&mut self, ability: &Ability, moment: &Moment) {
        let Some(at) = moment.at else {
            return;
        };
        let needed_s = |job: &Job| {
            let path_s = ability.travel_s(at.to(job.target(ability).0).length());
            path_s + job.left_s()
        };
        let hopeless = self.jobs.list.iter().find_map(|job| {
            if self.now_s > job.due_at_s {
                Some((job.task.id, Reason::Deadline))
            } else if needed_s(job) > moment.battery_s {
                Some((job.task.id, Reason::Battery))
            } else {
                None
            }
        });
        if let Some((goal, reason)) = hopeless {
            self.report_failure(goal, reason);
            self.release(goal, reason);
        }
    }

    /// The messages of a step with several awards: the others, then the awards, the lowest cost first. Otherwise the
    /// goals of the same controller would win whenever there is room for one.
    fn in_order<'p>(&self, ability: &Ability, moment: &'p Moment) -> Vec<&'p ReceivedMessage> {
        let cost_s = |received: &ReceivedMessage| match received.message.about {
            About::Contract(ContractMessage::Award(award)) => {
                let offer = self.offers.get(award.goal);
                let estimate = offer.and_then(|offer| self.estimate(offer, ability, moment).ok());
                estimate.map_or(f64::INFINITY, |estimate| estimate.cost_s())
            }
            _ => 0.0,
        };
        let inbox = moment.percept.inbox.iter();
        let mut ordered: Vec<(f64, &ReceivedMessage)> =
            inbox.map(|received| (cost_s(received), received)).collect();
        ordered.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        ordered.into_iter().map(|(_, received)| received).collect()
    }

    fn receive(&mut self, received: &ReceivedMessage, ability: &Ability, moment: &Moment) {
        let (from, about) = (received.from, received.message.about);
        if let (AgentRole::Person, About::Contract(order)) = (from.role, about) {
            self.obey(order);
        }
        if !from.is_controller() || !about.is_of_economy() {
            return;
        }
        self.schedule.note(from, self.now_s);
        let is_only_one = !received.message.to.is_all();
        match about {
            About::Contract(ContractMessage::Query {}) => {
                self.schedule.report_now(from, self.now_s);
            }
            About::Contract(ContractMessage::Call { number, task }) if task.is_valid() => {
                let offer = Offer::new(task, from, number, self.now_s);
                self.take_call(offer, is_only_one, ability, moment);
            }
            About::Contract(ContractMessage::Estimate(task)) if task.is_valid() => {
                self.answer_estimate(Offer::new(task, from, NO_CALL, self.now_s), ability, moment);
            }
            About::Contract(ContractMessage::Award(award)) => {
                self.take_award(from, award, ability, moment);
            }
            About::Contract(ContractMessage::Withdraw(claim)) => {
                self.take_withdrawal(from, claim, is_only_one);
            }
            About::Lease(message) => self.take_lease(from, message),
            _ => {}
        }
    }

    fn obey(&mut self, order: ContractMessage) {
        match order {
            ContractMessage::Service(is_in) => self.set_service(is_in),
            ContractMessage::Acknowledge(goal) => self.returned.remove(goal),
            _ => {}
        }
    }

    fn take_lease(&mut self, from: AgentId, message: LeaseMessage) {
        match message {
            LeaseMessage::Renewed(number) => self.holder.renew(from, number, self.now_s),
            LeaseMessage::RenewedOne(claim) => self.holder.renew_one(from, claim, self.now_s),
            LeaseMessage::Differs(number) if self.holder.differs(from, number) => {
                self.renew_each(from);
            }
            _ => {}
        }
    }

    /// A goal that has been served is no offer. A call to this robot alone is answered.
    fn take_call(&mut self, offer: Offer, is_only_one: bool, ability: &Ability, moment: &Moment) {
        let goal = offer.task.id;
        self.returned.remove(goal);
        if self.finished.contains(goal) {
            self.finished.report_to(goal, offer.owner, self.now_s);
            return;
        }
        if self.jobs.get(goal).is_some() {
            return;
        }
        self.offers.put(offer);
        if is_only_one {
            match self.estimate(&offer, ability, moment) {
                Ok(estimate) => self.send_bid(&estimate),
                Err(reason) => self.refuse(offer.owner, goal, offer.call.into(), reason),
            }
        }
    }

    fn take_award(&mut self, from: AgentId, award: Award, ability: &Ability, moment: &Moment) {
        let Award { goal, number, .. } = award;
        let claim = Claim { goal, number };
        if self.finished.contains(goal) {
            self.finished.report_to(goal, from, self.now_s);
            return;
        }
        if self.jobs.get(goal).is_some() {
            if self
                .holder
                .lease(goal)
                .is_some_and(|lease| lease.number == number)
            {
                self.send(from, ContractMessage::Commit(claim));
            }
            return;
        }
        match self.accepted(from, award, ability, moment) {
            Ok(()) => self.send(from, ContractMessage::Commit(claim)),
            Err(reason) => {
                self.holder.release(goal);
                self.refuse(from, goal, number, reason);
            }
        }
    }

    fn accepted(
        &mut self,
        from: AgentId,
        award: Award,
        ability: &Ability,
        moment: &Moment,
    ) -> Result<(), Reason> {
        let Award {
            goal,
            number,
            lease_s,
        } = award;
        let offered = self.offers.get(goal).filter(|offer| offer.owner == from);
        let (Some(offer), Some(at)) = (offered.copied(), moment.at) else {
            return Err(Reason::Lease);
        };
        if self.is_out_of_service {
            return Err(Reason::OutOfService);
        }
        if self.jobs.list.len() >= ability.max_goals {
            return Err(Reason::Full);
        }
        let claim = Claim { goal, number };
        let is_enough = lease_s > offer.task.service_s;
        if !is_enough || !self.holder.accept(from, claim, lease_s.into(), self.now_s) {
            return Err(Reason::Lease);
        }
        self.offers.remove(goal);
        self.jobs
            .add(Job::new(offer.task, from, offer.due_at_s), at);
        // The controller waits for one of both before its next award.
        self.schedule.await_bid();
        if self.jobs.list.len() >= ability.max_goals {
            self.schedule.report_now(from, self.now_s);
        }
        Ok(())
    }

    /// Out of service, the robot returns its goals; in service again, it reports to all controllers.
    fn set_service(&mut self, is_in: bool) {
        self.is_out_of_service = !is_in;
        if is_in {
            self.schedule.report_to_all(self.now_s);
            return;
        }
        let goals: Vec<GoalId> = self.jobs.list.iter().map(|job| job.task.id).collect();
        for goal in goals {
            if let Some(lease) = self.holder.lease(goal).copied() {
                self.refuse(lease.grantor, goal, lease.number, Reason::OutOfService);
            }
            self.drop_job(goal, Reason::OutOfService);
        }
    }

    fn take_withdrawal(&mut self, from: AgentId, claim: Claim, is_only_one: bool) {
        let goal = claim.goal;
        let is_winner = !is_only_one && self.holder.is_requested(from, claim);
        let offer = self.offers.get(goal);
        let bid = self.schedule.bid_of(from);
        if bid.is_some_and(|bid| bid.goal == goal) && !is_winner {
            // The next round of awards waits for another bid.
            self.schedule.await_bid();
        }
        if offer.is_some_and(|offer| offer.owner == from) && !is_winner {
            self.offers.remove(goal);
        }
        self.finished.acknowledge(goal, from);
        let lease = self.holder.lease(goal).copied();
        match lease {
            Some(lease) if lease.grantor != from => {}
            // The number is that of the lease, or of a request that the owner does not grant.
            Some(lease)
                if is_only_one
                    && (lease.number == claim.number || self.holder.is_answer(from, claim)) =>
            {
                self.release(goal, Reason::Lease);
            }
            // From now on, the robot accepts no grant that answers an earlier request.
            None if is_only_one && !self.finished.contains(goal) => {
                self.holder.release(goal);
                self.send(from, ContractMessage::Release(claim));
            }
            _ => {}
        }
    }

    /// Serves the goal at which the robot is. No service begins that cannot end within the lease.
    fn work(&mut self, ability: &Ability, moment: &Moment) {
        let (Some(at), Some(job)) = (moment.at, self.jobs.current(self.now_s).copied()) else {
            return;
        };
        let goal = job.task.id;
        self.wait(&job, ability, moment);
        if !is_there(&job, ability, at, moment.deviation_m) {
            // A service that was interrupted begins again.
            if let Some(job) = self.jobs.get_mut(goal) {
                job.served_s = 0.0;
                job.charges.is_firing = false;
            }
            return;
        }
        let lease = self.holder.lease(goal);
        let left_s = lease.map_or(0.0, |lease| lease.until_s - self.now_s);
        let Some(job) = self.jobs.get_mut(goal) else {
            return;
        };
        if !job.is_swept(ability) {
            job.corners += 1;
            job.visited += 1;
        } else if job.neutralises() {
            // A charge that has gone off is part of the service that has begun.
            if job.served_s > 0.0 || left_s > ability.work_s(&job.task) {
                self.neutralise(goal, ability, moment);
            }
        } else if job.left_s() <= 0.0 {
            if self.is_to_isolate(goal, ability, moment) {
                self.isolate(goal);
            } else {
                self.finish(goal);
            }
        } else if job.served_s > 0.0 || left_s > job.left_s() + moment.body.period_s {
            job.served_s += moment.body.period_s;
        }
    }

    /// Counts for how long the robot has stood at a goal without knowing its position well enough, and gives up after a
    /// time.
    fn wait(&mut self, job: &Job, ability: &Ability, moment: &Moment) {
        let (Some(at), deviation_m) = (moment.at, moment.deviation_m) else {
            return;
        };
        let (target, near_m) = job.target(ability);
        // Noise moves the position that it believes to and fro, although it stands.
        let is_still_there =
            job.waited_s > 0.0 && at.to(target).length() <= near_m + 2.0 * deviation_m;
        let is_uncertain = !is_certain(job, deviation_m);
        let waits = is_uncertain && (is_still_there || is_near(job, ability, at, deviation_m));
        let Some(job) = self.jobs.get_mut(job.task.id) else {
            return;
        };
        if waits {
            job.waited_s += moment.body.period_s;
        } else if is_uncertain {
            job.waited_s = 0.0;
        }
        if job.waited_s > IMPOSSIBLE_S && deviation_m > job.max_deviation_m() {
            (job.waited_s, job.verdict) = (0.0, Verdict::Impossible);
            let goal = job.task.id;
            self.fail(goal, Reason::Position);
        }
    }

    pub(super) fn finish(&mut self, goal: GoalId) {
        if let (Some(job), Some(lease)) = (self.jobs.remove(goal), self.holder.release(goal)) {
            let number = lease.number;
            self.interrogated = Some((job.task, job.charges.fence == Fence::Done))
                .filter(|(task, _)| task.work == Work::Interrogate);
            self.finished
                .add(Claim { goal, number }, job.owner, self.now_s);
        }
    }

    /// Ends a lease by message.
    pub(super) fn release(&mut self, goal: GoalId, reason: Reason) {
        if let Some(lease) = self.drop_job(goal, reason) {
            let number = lease.number;
            self.send(
                lease.grantor,
                ContractMessage::Release(Claim { goal, number }),
            );
        }
    }

    /// Serves a goal no longer, and reports that to the operator, in case that the owner is lost; returns its lease.
    fn drop_job(&mut self, goal: GoalId, reason: Reason) -> Option<Lease> {
        if self.jobs.remove(goal).is_some() {
            let number = 0;
            let report = Refusal {
                goal,
                number,
                reason,
            };
            self.returned.put_unserved(report, self.now_s);
        }
        self.holder.release(goal)
    }
}

fn is_award(received: &ReceivedMessage) -> bool {
    matches!(
        received.message.about,
        About::Contract(ContractMessage::Award(_))
    )
}

/// Whether a robot at a position with a standard deviation is at a goal.
fn is_there(job: &Job, ability: &Ability, at: Point, deviation_m: f64) -> bool {
    is_near(job, ability, at, deviation_m) && is_certain(job, deviation_m)
}

/// Whether the position is known well enough for a service that has not begun.
fn is_certain(job: &Job, deviation_m: f64) -> bool {
    job.has_begun() || job.is_certain(deviation_m)
}

fn is_near(job: &Job, ability: &Ability, at: Point, deviation_m: f64) -> bool {
    if ability.is_stationary() {
        return ability.covers(&job.task, at);
    }
    let (target, near_m) = job.target(ability);
    let near_m = if job.has_begun() {
        near_m
    } else {
        ability.approach_m(&job.task, job.within_m(near_m, deviation_m))
    };
    at.to(target).length() <= near_m
}
