//! The goals that a controller owns, and what it has to report of goals.

pub(super) mod lapses;
pub(super) mod owned;

use super::handover::{NO_REQUEST, Role};
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Claim, GoalId, Holder, OperatorReports, Task};
use owned::Owned;

#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Ledger {
    /// The goals that it owns, or is a candidate for.
    pub(super) goals: Vec<Owned>,
    /// The votes of others for these goals: ownership leases.
    pub(super) voters: Vec<Voter>,
    pub(super) reports: OperatorReports,
    /// Number of goals that it refused.
    pub(super) refused: u32,
}

/// The leases that another controller has granted.
#[derive(Debug, Clone, Hashed)]
pub(super) struct Voter {
    pub(super) id: AgentId,
    pub(super) leases: Holder,
}

impl Ledger {
    pub(super) fn get(&self, goal: GoalId) -> Option<&Owned> {
        self.goals.iter().find(|owned| owned.task.id == goal)
    }

    pub(super) fn get_mut(&mut self, goal: GoalId) -> Option<&mut Owned> {
        let mut goals = self.goals.iter_mut();
        goals.find(|owned| owned.task.id == goal)
    }

    /// Whether it owns a goal that is not done, or is a candidate for it.
    pub(super) fn has_undone(&self, goal: GoalId) -> bool {
        self.get(goal).is_some_and(|owned| !owned.is_done)
    }

    /// The goals for which it is a candidate again, after it has reported that no controller owns them.
    pub(super) fn lost(&self) -> impl Iterator<Item = Task> {
        let goals = self.goals.iter();
        let lost = goals.filter(|it| it.is_reported && it.role != Role::Owner && !it.is_done);
        lost.map(|owned| owned.task)
    }

    /// Number of goals that can still be served.
    pub(super) fn open(&self, now_s: f64) -> usize {
        let open = self.goals.iter().filter(|owned| owned.is_open(now_s));
        open.count()
    }

    /// Whether it owns a goal that is not done, at a time on its clock.
    pub(super) fn owns_at(&self, goal: GoalId, time_s: f64) -> bool {
        self.get(goal).is_some_and(|owned| owned.is_held(time_s))
    }

    /// The leases that a controller has granted, or may grant.
    pub(super) fn leases_of(&mut self, id: AgentId) -> &mut Holder {
        let known = self.voters.iter().position(|voter| voter.id == id);
        let index = known.unwrap_or_else(|| {
            let leases = Holder::default();
            self.voters.push(Voter { id, leases });
            self.voters.len() - 1
        });
        &mut self.voters[index].leases
    }

    /// The controllers that vote for it as the owner of a goal, and until when they do.
    pub(super) fn votes_for(&self, goal: GoalId) -> impl Iterator<Item = (AgentId, f64)> {
        self.voters.iter().filter_map(move |voter| {
            let lease = voter.leases.lease(goal)?;
            Some((voter.id, lease.until_s))
        })
    }

    /// Ends all votes for a goal; returns those that others may have given, each with the number that they know.
    pub(super) fn release(&mut self, goal: GoalId) -> Vec<(AgentId, Claim)> {
        let mut released = Vec::new();
        let votes = self.get(goal).map(|owned| owned.votes.clone());
        for vote in votes.unwrap_or_default() {
            let lease = self.leases_of(vote.voter).release(goal);
            let number = lease.map_or(vote.number, |lease| lease.number);
            if number != NO_REQUEST {
                released.push((vote.voter, Claim { goal, number }));
            }
        }
        released
    }

    /// Notes until when a majority votes for it as the owner of each goal, with this number of votes of others.
    pub(super) fn count_votes(&mut self, needed: usize) {
        for index in 0..self.goals.len() {
            let until_s = self.majority_until_s(self.goals[index].task.id, needed);
            self.goals[index].held_until_s = until_s;
        }
    }

    /// The same for one goal.
    pub(super) fn count_votes_for(&mut self, goal: GoalId, needed: usize) {
        let until_s = self.majority_until_s(goal, needed);
        if let Some(owned) = self.get_mut(goal) {
            owned.held_until_s = until_s;
        }
    }

    fn majority_until_s(&self, goal: GoalId, needed: usize) -> f64 {
        let mut ends_s: Vec<f64> = self.votes_for(goal).map(|(_, until_s)| until_s).collect();
        ends_s.sort_by(|one, other| other.total_cmp(one));
        let has_giver = self.get(goal).is_some_and(|owned| owned.giver.is_some());
        match needed.max(has_giver.into()).checked_sub(1) {
            None => f64::INFINITY,
            Some(last) => ends_s.get(last).copied().unwrap_or(f64::NEG_INFINITY),
        }
    }
}
