//! What is counted of goals: when each was issued and served, and the robot that served it.

use super::events::EventLog;
use super::goal_moment::GoalMoment;
use super::journey::{Journey, Service};
use super::stays::Stays;
use crate::bodies::body_state::Status;
use crate::radio::channel::Outgoing;
use base::hashed::Hashed;
use brain::{About, AgentId, CommitmentStatus, ContractMessage, GoalId, Reason};
use std::mem::replace;

/// Counts of the goals of a run, and of its messages.
#[derive(Debug, Clone, Default, PartialEq, Hashed)]
pub(crate) struct GoalTally {
    /// By the number of the goal.
    pub(crate) records: Vec<GoalRecord>,
    /// By the number of the robot.
    pub(crate) journeys: Vec<Journey>,
    stays: Stays,
    pub(crate) messages_sent: u64,
    /// Messages beyond the maximum of a step: of the radio of the sender, which did not send them, or of a receiver.
    pub(crate) messages_dropped: u64,
}

/// What happened to one goal so far, in steps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Hashed)]
pub(crate) struct GoalRecord {
    pub(crate) issued_at: Option<u64>,
    /// The controller that it was issued to.
    pub(crate) issued_to: Option<AgentId>,
    /// When it was first awarded to a robot.
    pub(crate) awarded_at: Option<u64>,
    /// When a robot first drove there.
    pub(crate) pursued_at: Option<u64>,
    pub(crate) served: Option<Service>,
    /// Whether several robots served it.
    pub(crate) is_served_twice: bool,
    /// Why no robot can serve it, as a controller last reported to the operator.
    pub(crate) unserved: Option<Reason>,
    /// Why the robot to which it was awarded last serves it no longer, as the robot has reported to the operator.
    pub(crate) returned: Option<Reason>,
    /// Whether a robot has reported that it served the goal when it had not: it was not there, or not long enough. It
    /// follows from the messages, and affects no other outcome.
    #[hashed(skip)]
    pub(crate) is_done_in_error: bool,
}

impl GoalRecord {
    /// Why it is not served, as far as that was reported.
    pub(crate) fn reason(&self) -> Option<Reason> {
        let in_error = self.is_done_in_error.then_some(Reason::DoneInError);
        self.unserved.or(self.returned).or(in_error)
    }
}

impl GoalTally {
    /// The tally of a run that begins.
    pub(crate) fn new(goals: usize, robots: usize) -> Self {
        Self {
            records: vec![GoalRecord::default(); goals],
            journeys: vec![Journey::default(); robots],
            ..Self::default()
        }
    }

    /// Takes over how long robots have been at goals; `robot` and `goal` return their numbers now.
    pub(crate) fn keep_stays(
        &mut self,
        before: &Self,
        robot: impl Fn(usize) -> Option<usize>,
        goal: impl Fn(usize) -> Option<usize>,
    ) {
        self.stays = before.stays.renumbered(robot, goal);
    }

    /// Notes where robots are, the messages that they send, and reports that goals are done for which their radio had no
    /// room: they were served all the same. Returns whether any of it counts.
    pub(crate) fn observe<'m>(
        &mut self,
        moment: &GoalMoment,
        (sent, unsent_done): (
            impl Iterator<Item = &'m Outgoing> + Clone,
            impl Iterator<Item = &'m Outgoing>,
        ),
        events: &EventLog,
    ) -> bool {
        self.follow(moment);
        let records = &self.records;
        self.stays
            .follow(moment, |goal| records[goal].issued_at.is_some());
        let mut is_counted = false;
        for outgoing in sent.clone() {
            self.messages_sent += 1;
            self.note_unserved(moment, outgoing);
        }
        for outgoing in sent.clone().chain(unsent_done) {
            if let Some(goal) = done(outgoing).and_then(|id| moment.goals.number(id)) {
                let robot = outgoing.from as usize;
                if self.note_done(moment, robot, goal) {
                    is_counted = true;
                    events.note(moment.tick, moment.service(robot, goal));
                }
            }
        }
        // A robot that reports a goal as done may report in the same step that it drives to the next.
        sent.for_each(|outgoing| self.note_commitment(moment, outgoing));
        is_counted
    }

    fn follow(&mut self, moment: &GoalMoment) {
        for (robot, journey) in self.journeys.iter_mut().enumerate() {
            let Some(goal) = journey.goal else {
                continue;
            };
            let body_state = &moment.body_states[robot];
            if body_state.status == Status::Active {
                let is_near = moment.is_near(robot, &moment.goals.all[goal]);
                journey.go_on(moment.tick, body_state, is_near);
            } else {
                *journey = Journey::default();
            }
        }
    }

    /// Notes that a controller reports to the operator that no robot can serve a goal, or a robot that it serves it no longer.
    fn note_unserved(&mut self, moment: &GoalMoment, outgoing: &Outgoing) {
        let message = &outgoing.message;
        let is_of_controller = self.journeys.len() <= outgoing.from as usize;
        if let About::Contract(ContractMessage::Stuck(refusal)) = message.about
            && let Some(goal) = moment.goals.number(refusal.goal)
            && message.to == AgentId::OPERATOR.into()
        {
            if is_of_controller {
                self.records[goal].unserved = Some(refusal.reason);
            } else {
                self.records[goal].returned = Some(refusal.reason);
            }
        }
    }

    fn note_commitment(&mut self, moment: &GoalMoment, outgoing: &Outgoing) {
        let (id, status) = match outgoing.message.about {
            About::Goal { id, status, .. } => (id, status),
            About::Contract(ContractMessage::Award(award)) => {
                if let Some(goal) = moment.goals.number(award.goal) {
                    let record = &mut self.records[goal];
                    record.awarded_at.get_or_insert(moment.tick);
                    (record.unserved, record.returned) = (None, None);
                }
                return;
            }
            _ => return,
        };
        let (robot, goal) = (outgoing.from as usize, moment.goals.number(id));
        let Some(journey) = self.journeys.get_mut(robot) else {
            return;
        };
        match status {
            CommitmentStatus::Active if journey.goal != goal => {
                let is_near =
                    goal.is_some_and(|goal| moment.is_near(robot, &moment.goals.all[goal]));
                *journey = Journey::begin(goal, moment.tick, is_near);
                if let Some(goal) = goal {
                    self.records[goal].pursued_at.get_or_insert(moment.tick);
                }
            }
            CommitmentStatus::Released if journey.goal == goal => *journey = Journey::default(),
            _ => {}
        }
    }

    /// Notes that a robot reported a goal as done; returns whether it counts.
    fn note_done(&mut self, moment: &GoalMoment, robot: usize, number: usize) -> bool {
        let Some(&id) = moment.ids.get(robot) else {
            return false;
        };
        let (goal, now) = (&moment.goals.all[number], moment.tick);
        let record = &mut self.records[number];
        let since = self.stays.since(robot, number).unwrap_or(now);
        let journey = self.journeys[robot].to(number, since);
        let Some(issued_at) = record.issued_at else {
            return false;
        };
        if !moment.is_near(robot, goal) || !moment.is_long_enough(goal, now - since) {
            record.is_done_in_error |= record.served.is_none();
            return false;
        }
        if moment.is_late(goal, issued_at) {
            return false;
        }
        let is_new = match &record.served {
            Some(served) if served.by == Some(id) => return false,
            Some(_) => !replace(&mut record.is_served_twice, true),
            None => {
                record.served = Some(journey.service(id, issued_at, now));
                true
            }
        };
        if self.journeys[robot].goal == Some(number) {
            self.journeys[robot] = Journey::default();
        }
        is_new
    }

    /// Whether a robot is at a goal whose service takes time.
    pub(crate) fn is_in_service(&self, robot: usize, goal: usize) -> bool {
        self.stays.since(robot, goal).is_some()
    }

    /// Number of goals that a robot reported as served in error, and that none has served.
    pub(crate) fn done_in_error(&self) -> usize {
        let records = self.records.iter();
        let in_error = records.filter(|record| record.is_done_in_error && record.served.is_none());
        in_error.count()
    }

    /// Number of goals that were served.
    #[expect(clippy::cast_possible_truncation, reason = "goals have 32-bit numbers")]
    pub(crate) fn served(&self) -> u32 {
        self.services().count() as u32
    }

    /// The services of goals, each with the step in which the goal was issued.
    pub(crate) fn services(&self) -> impl Iterator<Item = (u64, Service)> {
        let records = self.records.iter();
        records.filter_map(|record| Some((record.issued_at?, record.served?)))
    }

    /// Number of goals that several robots served.
    pub(crate) fn served_twice(&self) -> usize {
        let twice = self.records.iter();
        twice.filter(|record| record.is_served_twice).count()
    }
}

/// The goal that a message reports as done by its sender.
fn done(outgoing: &Outgoing) -> Option<GoalId> {
    match outgoing.message.about {
        About::Goal {
            id,
            status: CommitmentStatus::Done,
            ..
        } => Some(id),
        About::Contract(ContractMessage::Done(claim)) => Some(claim.goal),
        _ => None,
    }
}
