//! A goal that a controller owns, and what has happened to it.

use super::lapses::Lapses;
use crate::controller::handover::{Role, Vote};
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Reason, Task};

/// Maximum number of robots that are remembered for a goal: those that have been awarded it, and those that
/// cannot serve it.
const MAX_ROBOTS: usize = 64;
const MAX_DECLINED: usize = 1024;

/// Adds a robot to those that have been awarded a goal; the first one is forgotten first.
pub(crate) fn note_assignee(assignees: &mut Vec<AgentId>, robot: AgentId) {
    if !assignees.contains(&robot) {
        if assignees.len() == MAX_ROBOTS {
            assignees.remove(0);
        }
        assignees.push(robot);
    }
}

/// A goal that no robot can serve is tried again after this time, in seconds; each further failure
/// doubles it, up to a maximum.
const MIN_REST_S: f64 = 20.0;
const MAX_REST_S: f64 = 320.0;

/// A goal that a controller owns.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Owned {
    pub(crate) task: Task,
    /// Its deadline on the controller's clock.
    pub(crate) due_at_s: f64,
    pub(crate) is_done: bool,
    pub(crate) role: Role,
    /// The votes of others, and until when a majority votes for this controller.
    pub(crate) votes: Vec<Vote>,
    pub(crate) held_until_s: f64,
    /// The owner before this controller.
    pub(crate) origin: Option<AgentId>,
    /// That owner, if it has transferred the goal and its vote is needed although controllers own goals alone.
    pub(crate) giver: Option<AgentId>,
    /// When it is offered to other controllers next, and the cost that their prices have to be below.
    pub(crate) next_offer_s: f64,
    pub(crate) limit_s: f64,
    /// Whether it has been reported that no controller owns it.
    pub(crate) is_reported: bool,
    /// From when on it can be awarded.
    pub(crate) ready_s: f64,
    /// Number of its offer, when that was called first, and when it is called next.
    pub(crate) call: u16,
    pub(crate) called_s: Option<f64>,
    pub(crate) next_call_s: f64,
    pub(crate) assigned: Option<Assigned>,
    /// Since when no robot has bid for it, and when the next is called alone.
    pub(crate) without_bid_s: f64,
    pub(crate) next_probe_s: f64,
    /// The robots that cannot serve it, until when, and the last reason.
    pub(crate) declined: Vec<(AgentId, f64)>,
    pub(crate) reason: Reason,
    pub(crate) rest: Rest,
    /// The robots that have been awarded it.
    pub(crate) assignees: Vec<AgentId>,
    pub(crate) lapses: Lapses,
    /// How often a robot has lost it without serving it.
    pub(crate) failures: u16,
    /// The robot that is to be awarded it next, as it has displaced another goal of the robot.
    pub(crate) reserved: Option<Reservation>,
}

/// The award of a goal.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct Assigned {
    pub(crate) robot: AgentId,
    /// Number of the bid.
    pub(crate) number: u32,
    pub(crate) is_committed: bool,
    pub(crate) awarded_s: f64,
    /// Duration of the lease.
    pub(crate) lease_s: f64,
    /// When the award, or the withdrawal, is sent again.
    pub(crate) next_s: f64,
    /// When the robot should have served it.
    pub(crate) overdue_s: f64,
    /// Whether other robots can bid for it.
    pub(crate) is_contested: bool,
    /// Since when the robot has reported that it does not reach it; infinity if it does.
    pub(crate) stuck_s: f64,
    /// Whether the robot is to release it.
    pub(crate) is_withdrawn: bool,
    /// When the robot is there, by its last report; infinity before.
    pub(crate) there_s: f64,
}

/// A robot that is to be awarded a goal first.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct Reservation {
    pub(crate) robot: AgentId,
    pub(crate) until_s: f64,
}

/// The rest of a goal that no robot can serve.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct Rest {
    pub(crate) until_s: f64,
    /// Its duration after the last failure; 0 before the first.
    pub(crate) total_s: f64,
}

impl Owned {
    /// A goal for which the controller is a candidate.
    pub(crate) fn new(task: Task, now_s: f64, free_until_s: f64) -> Self {
        Self {
            task,
            due_at_s: now_s + f64::from(task.due_s),
            is_done: false,
            role: Role::Candidate {
                since_s: now_s,
                free_until_s,
            },
            votes: Vec::new(),
            held_until_s: f64::NEG_INFINITY,
            origin: None,
            giver: None,
            next_offer_s: f64::NEG_INFINITY,
            limit_s: f64::INFINITY,
            is_reported: false,
            ready_s: f64::INFINITY,
            call: 0,
            called_s: None,
            next_call_s: f64::INFINITY,
            assigned: None,
            without_bid_s: f64::INFINITY,
            next_probe_s: f64::INFINITY,
            declined: Vec::new(),
            reason: Reason::NoRobot,
            rest: Rest {
                until_s: f64::NEG_INFINITY,
                total_s: 0.0,
            },
            assignees: Vec::new(),
            lapses: Lapses::default(),
            failures: 0,
            reserved: None,
        }
    }

    /// Whether the controller owns it at a time.
    pub(crate) fn is_held(&self, time_s: f64) -> bool {
        self.role == Role::Owner && !self.is_done && time_s < self.held_until_s
    }

    /// The controller owns it from now on, and awards it after a time.
    pub(crate) fn win(&mut self, now_s: f64, wait_s: f64) {
        (self.role, self.is_reported) = (Role::Owner, false);
        self.ready_s = now_s + wait_s;
        (self.next_call_s, self.called_s) = (self.ready_s, None);
        (self.without_bid_s, self.next_probe_s) = (self.ready_s, self.ready_s);
    }

    /// Whether the controller is a candidate to which the owner has transferred it.
    pub(crate) fn is_of_transfer(&self) -> bool {
        matches!(self.role, Role::Candidate { free_until_s, .. } if free_until_s.is_finite())
    }

    /// Whether the owner before this controller votes for it, or is to know that it has been served, where controllers own
    /// goals alone.
    pub(crate) fn is_traded_with(&self, other: AgentId) -> bool {
        let is_origin = self.origin == Some(other);
        is_origin && (self.giver.is_some() || self.is_done)
    }

    /// The vote of another controller.
    pub(crate) fn vote_of(&mut self, voter: AgentId, now_s: f64) -> &mut Vote {
        let known = self.votes.iter().position(|vote| vote.voter == voter);
        let index = known.unwrap_or_else(|| {
            self.votes.push(Vote::new(voter, now_s));
            self.votes.len() - 1
        });
        &mut self.votes[index]
    }

    /// It has been served: the voters are to know that.
    pub(crate) fn finish(&mut self, now_s: f64) {
        (self.is_done, self.assigned) = (true, None);
        for vote in &mut self.votes {
            vote.next_s = now_s;
        }
    }

    /// Whether robots can bid for it.
    pub(crate) fn is_on_offer(&self, now_s: f64) -> bool {
        let is_free = self.assigned.is_none_or(|assigned| assigned.is_contested);
        let is_owned = self.role == Role::Owner && !self.is_done;
        is_owned && is_free && now_s >= self.ready_s && now_s >= self.rest.until_s
    }

    /// Offers it again: bids for the last offer do not count.
    pub(crate) fn offer_again(&mut self, now_s: f64) {
        self.call = self.call.wrapping_add(1);
        (self.called_s, self.next_call_s) = (None, now_s);
        (self.without_bid_s, self.next_probe_s) = (now_s, now_s);
    }

    /// The description that is sent now.
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(crate) fn task_at(&self, now_s: f64) -> Task {
        let due_s = (self.due_at_s - now_s).clamp(0.0, f64::from(f32::MAX));
        Task {
            due_s: due_s as f32,
            ..self.task
        }
    }

    /// Notes that a robot cannot serve it.
    pub(crate) fn decline(&mut self, robot: AgentId, until_s: f64, reason: Reason) {
        self.declined.retain(|(declined, _)| *declined != robot);
        if self.declined.len() == MAX_DECLINED {
            self.declined.remove(0);
        }
        self.declined.push((robot, until_s));
        self.reason = reason;
    }

    pub(crate) fn is_declined_by(&self, robot: AgentId, now_s: f64) -> bool {
        let mut declined = self.declined.iter();
        declined.any(|(declined, until_s)| *declined == robot && now_s < *until_s)
    }

    /// No robot can serve it: it rests, after each failure for longer.
    pub(crate) fn give_up(&mut self, now_s: f64) {
        let rest = &mut self.rest;
        rest.total_s = (2.0 * rest.total_s).clamp(MIN_REST_S, MAX_REST_S);
        rest.until_s = now_s + rest.total_s;
        self.declined.clear();
        let until_s = rest.until_s;
        self.offer_again(until_s);
    }

    /// Its deadline has passed: it is offered no more.
    pub(crate) fn end(&mut self) {
        self.rest.until_s = f64::INFINITY;
    }

    /// Whether it can still be served: it is neither done nor past its deadline.
    pub(crate) fn is_open(&self, now_s: f64) -> bool {
        !self.is_done && (self.assigned.is_some() || now_s < self.due_at_s)
    }

    /// What robots can do has changed.
    pub(crate) fn try_again(&mut self, now_s: f64) {
        if now_s < self.rest.until_s && now_s < self.due_at_s {
            self.rest.until_s = now_s;
            self.offer_again(now_s);
        }
    }

    /// Why no robot can serve it at present, if that is so.
    pub(crate) fn unserved(&self, now_s: f64) -> Option<Reason> {
        (now_s < self.rest.until_s).then_some(self.reason)
    }

    /// Whether no robot could serve it when it was offered last, and none has been awarded it since.
    pub(crate) fn is_hopeless(&self) -> bool {
        self.rest.total_s > 0.0 && self.assigned.is_none()
    }

    pub(crate) fn assign(&mut self, assigned: Assigned) {
        note_assignee(&mut self.assignees, assigned.robot);
        // Its award ends its reservation.
        if let Some(reserved) = &mut self.reserved {
            reserved.until_s = reserved.until_s.min(assigned.awarded_s);
        }
        self.assigned = Some(assigned);
        (self.rest.total_s, self.called_s) = (0.0, None);
    }
}
