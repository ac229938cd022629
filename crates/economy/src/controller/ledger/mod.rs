//! The goals that a controller owns, and what it has to report of goals.

pub(super) mod lapses;
pub(super) mod owned;

use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{GoalId, Holder, OperatorReports};
use owned::Owned;

#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Ledger {
    pub(super) goals: Vec<Owned>,
    /// The ownership leases under which it owns goals that have a backup.
    pub(super) leases: Holder,
    pub(super) reports: OperatorReports,
    /// Number of goals that it refused.
    pub(super) refused: u32,
}

impl Ledger {
    pub(super) fn get(&self, goal: GoalId) -> Option<&Owned> {
        self.goals.iter().find(|owned| owned.task.id == goal)
    }

    pub(super) fn get_mut(&mut self, goal: GoalId) -> Option<&mut Owned> {
        let mut goals = self.goals.iter_mut();
        goals.find(|owned| owned.task.id == goal)
    }

    /// Whether it owns a goal that is not done.
    pub(super) fn has_undone(&self, goal: GoalId) -> bool {
        self.get(goal).is_some_and(|owned| !owned.is_done)
    }

    /// Number of goals that can still be served.
    pub(super) fn open(&self, now_s: f64) -> usize {
        let open = self.goals.iter().filter(|owned| owned.is_open(now_s));
        open.count()
    }

    /// Whether it owns a goal that is not done, at a time on its clock.
    pub(super) fn owns_at(&self, goal: GoalId, time_s: f64) -> bool {
        let owned = self.get(goal).filter(|owned| !owned.is_done);
        owned.is_some_and(|owned| {
            owned.handover.bound().is_none() || self.leases.is_held(goal, time_s)
        })
    }
}
