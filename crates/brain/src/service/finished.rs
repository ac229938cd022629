//! The goals that a robot has served: it reports each until the owner has withdrawn it.

use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalId;
use crate::io::lease::Claim;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// Maximum number of goals that are remembered; the oldest is forgotten first.
const MAX_GOALS: usize = 128;

/// Time between two reports, in seconds, and their maximum number.
const PERIOD_S: f64 = 2.0;
const MAX_REPORTS: u8 = 30;

/// The goals that a robot has served.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Finished {
    list: Vec<Service>,
}

#[derive(Debug, Clone, Copy, Hashed)]
struct Service {
    claim: Claim,
    owner: AgentId,
    /// Remaining number of reports, and the time of the next.
    left: u8,
    next_s: f64,
}

impl Finished {
    pub(crate) fn add(&mut self, claim: Claim, owner: AgentId, now_s: f64) {
        if self.list.len() == MAX_GOALS {
            self.list.remove(0);
        }
        self.list.push(Service {
            claim,
            owner,
            left: MAX_REPORTS,
            next_s: now_s,
        });
    }

    pub(crate) fn contains(&self, goal: GoalId) -> bool {
        self.list.iter().any(|service| service.claim.goal == goal)
    }

    /// The goals that it still reports.
    pub(crate) fn reported(&self) -> impl Iterator<Item = GoalId> {
        let reported = self.list.iter().filter(|service| service.left > 0);
        reported.map(|service| service.claim.goal)
    }

    /// A controller offers or awards a goal that has been served: it has to know.
    pub(crate) fn report_to(&mut self, goal: GoalId, owner: AgentId, now_s: f64) {
        let mut list = self.list.iter_mut();
        if let Some(service) = list.find(|service| service.claim.goal == goal) {
            let is_due = service.left == 0 || service.owner != owner;
            service.left = MAX_REPORTS;
            service.owner = owner;
            if is_due {
                service.next_s = now_s;
            }
        }
    }

    /// The owner knows.
    pub(crate) fn acknowledge(&mut self, goal: GoalId, owner: AgentId) {
        let mut list = self.list.iter_mut();
        let is_it = |service: &&mut Service| service.claim.goal == goal && service.owner == owner;
        if let Some(service) = list.find(is_it) {
            service.left = 0;
        }
    }

    /// The reports that are due, with their receivers.
    pub(crate) fn due(&mut self, now_s: f64) -> impl Iterator<Item = (AgentId, Claim)> {
        let due = move |service: &mut Service| {
            let is_due = service.left > 0 && now_s >= service.next_s;
            if is_due {
                (service.left, service.next_s) = (service.left - 1, now_s + PERIOD_S);
            }
            is_due.then_some((service.owner, service.claim))
        };
        self.list.iter_mut().filter_map(due)
    }
}
