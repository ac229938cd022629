//! A goal that a controller owns, and what has happened to it.

use super::lapses::Lapses;
use crate::controller::handover::Handover;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Reason, Task};

/// Maximum number of robots that are remembered for a goal: those that have been awarded it, and those that
/// cannot serve it.
const MAX_ROBOTS: usize = 64;
const MAX_DECLINED: usize = 1024;

/// Adds a robot to those that have been awarded a goal; the first one is forgotten first.
pub(in super::super) fn note_assignee(assignees: &mut Vec<AgentId>, robot: AgentId) {
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
pub(in super::super) struct Owned {
    pub(in super::super) task: Task,
    /// Its deadline on the controller's clock.
    pub(in super::super) due_at_s: f64,
    pub(in super::super) is_done: bool,
    /// The owner that has lost it to this controller, its backup.
    pub(in super::super) origin: Option<AgentId>,
    /// When it is offered to that owner again; minus infinity if it never was.
    pub(in super::super) next_return_s: f64,
    /// From when on it can be awarded.
    pub(in super::super) ready_s: f64,
    /// Number of its offer, when that was called first, and when it is called next.
    pub(in super::super) call: u16,
    pub(in super::super) called_s: Option<f64>,
    pub(in super::super) next_call_s: f64,
    pub(in super::super) assigned: Option<Assigned>,
    pub(in super::super) handover: Handover,
    /// Since when no robot has bid for it, and when the next is called alone.
    pub(in super::super) without_bid_s: f64,
    pub(in super::super) next_probe_s: f64,
    /// The robots that cannot serve it, until when, and the last reason.
    pub(in super::super) declined: Vec<(AgentId, f64)>,
    pub(in super::super) reason: Reason,
    pub(in super::super) rest: Rest,
    /// The robots that have been awarded it.
    pub(in super::super) assignees: Vec<AgentId>,
    pub(in super::super) lapses: Lapses,
    /// How often a robot has lost it without serving it.
    pub(in super::super) failures: u8,
    /// The robot that is to be awarded it next, as it has displaced another goal of the robot.
    pub(in super::super) reserved: Option<Reservation>,
}

/// The award of a goal.
#[derive(Debug, Clone, Copy, Hashed)]
pub(in super::super) struct Assigned {
    pub(in super::super) robot: AgentId,
    /// Number of the bid.
    pub(in super::super) number: u32,
    pub(in super::super) is_committed: bool,
    pub(in super::super) awarded_s: f64,
    /// Duration of the lease.
    pub(in super::super) lease_s: f64,
    /// When the award, or the withdrawal, is sent again.
    pub(in super::super) next_s: f64,
    /// When the robot should have served it.
    pub(in super::super) overdue_s: f64,
    /// Whether other robots can bid for it.
    pub(in super::super) is_contested: bool,
    /// Since when the robot has reported that it does not reach it; infinity if it does.
    pub(in super::super) stuck_s: f64,
    /// Whether the robot is to release it.
    pub(in super::super) is_withdrawn: bool,
    /// When the robot is there, by its last report; infinity before.
    pub(in super::super) there_s: f64,
}

/// A robot that is to be awarded a goal first.
#[derive(Debug, Clone, Copy, Hashed)]
pub(in super::super) struct Reservation {
    pub(in super::super) robot: AgentId,
    pub(in super::super) until_s: f64,
}

/// The rest of a goal that no robot can serve.
#[derive(Debug, Clone, Copy, Hashed)]
pub(in super::super) struct Rest {
    pub(in super::super) until_s: f64,
    /// Its duration after the last failure; 0 before the first.
    pub(in super::super) total_s: f64,
}

impl Owned {
    /// A goal that can be awarded after a time.
    pub(in super::super) fn new(task: Task, now_s: f64, wait_s: f64) -> Self {
        Self {
            task,
            due_at_s: now_s + f64::from(task.due_s),
            is_done: false,
            origin: None,
            next_return_s: f64::NEG_INFINITY,
            ready_s: now_s + wait_s,
            call: 0,
            called_s: None,
            next_call_s: now_s + wait_s,
            assigned: None,
            handover: Handover::Alone,
            without_bid_s: now_s + wait_s,
            next_probe_s: now_s + wait_s,
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

    /// Whether robots can bid for it.
    pub(in super::super) fn is_on_offer(&self, now_s: f64) -> bool {
        let is_free = self.assigned.is_none_or(|assigned| assigned.is_contested);
        !self.is_done && is_free && now_s >= self.ready_s && now_s >= self.rest.until_s
    }

    /// Offers it again: bids for the last offer do not count.
    pub(in super::super) fn offer_again(&mut self, now_s: f64) {
        self.call = self.call.wrapping_add(1);
        (self.called_s, self.next_call_s) = (None, now_s);
        (self.without_bid_s, self.next_probe_s) = (now_s, now_s);
    }

    /// The description that is sent now.
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(in super::super) fn task_at(&self, now_s: f64) -> Task {
        let due_s = (self.due_at_s - now_s).clamp(0.0, f64::from(f32::MAX));
        Task {
            due_s: due_s as f32,
            ..self.task
        }
    }

    /// Notes that a robot cannot serve it.
    pub(in super::super) fn decline(&mut self, robot: AgentId, until_s: f64, reason: Reason) {
        self.declined.retain(|(declined, _)| *declined != robot);
        if self.declined.len() == MAX_DECLINED {
            self.declined.remove(0);
        }
        self.declined.push((robot, until_s));
        self.reason = reason;
    }

    pub(in super::super) fn is_declined_by(&self, robot: AgentId, now_s: f64) -> bool {
        let mut declined = self.declined.iter();
        declined.any(|(declined, until_s)| *declined == robot && now_s < *until_s)
    }

    /// No robot can serve it: it rests, after each failure for longer.
    pub(in super::super) fn give_up(&mut self, now_s: f64) {
        let rest = &mut self.rest;
        rest.total_s = (2.0 * rest.total_s).clamp(MIN_REST_S, MAX_REST_S);
        rest.until_s = now_s + rest.total_s;
        self.declined.clear();
        let until_s = rest.until_s;
        self.offer_again(until_s);
    }

    /// Its deadline has passed: it is offered no more.
    pub(in super::super) fn end(&mut self) {
        self.rest.until_s = f64::INFINITY;
    }

    /// Whether it can still be served: it is neither done nor past its deadline.
    pub(in super::super) fn is_open(&self, now_s: f64) -> bool {
        !self.is_done && (self.assigned.is_some() || now_s < self.due_at_s)
    }

    /// What robots can do has changed.
    pub(in super::super) fn try_again(&mut self, now_s: f64) {
        if now_s < self.rest.until_s && now_s < self.due_at_s {
            self.rest.until_s = now_s;
            self.offer_again(now_s);
        }
    }

    /// Why no robot can serve it at present, if that is so.
    pub(in super::super) fn unserved(&self, now_s: f64) -> Option<Reason> {
        (now_s < self.rest.until_s).then_some(self.reason)
    }

    /// Whether no robot could serve it when it was offered last, and none has been awarded it since.
    pub(in super::super) fn is_hopeless(&self) -> bool {
        self.rest.total_s > 0.0 && self.assigned.is_none()
    }

    pub(in super::super) fn assign(&mut self, assigned: Assigned) {
        note_assignee(&mut self.assignees, assigned.robot);
        // Its award ends its reservation.
        if let Some(reserved) = &mut self.reserved {
            reserved.until_s = reserved.until_s.min(assigned.awarded_s);
        }
        self.assigned = Some(assigned);
        (self.rest.total_s, self.called_s) = (0.0, None);
    }
}
