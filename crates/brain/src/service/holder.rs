//! The holder's half of leases.
//!
//! A lease lasts for its duration on the holder's own clock *from sending the request* that the
//! grant answers by number. The grant was sent later than that, so the
//! [grantor](super::grantor), which counts from there, never waits too short.

use super::set_hash::set_hash;
use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalId;
use crate::io::lease::{Claim, Renewal};
use alloc::vec::Vec;
use base::hashed::Hashed;

/// Maximum number of requests without an answer; the oldest is forgotten first.
const MAX_REQUESTS: usize = 64;

/// Longer leases are invalid, in seconds.
const MAX_LEASE_S: f64 = 3600.0;

/// The leases that an agent holds.
#[derive(Debug, Clone, Default, Hashed)]
pub struct Holder {
    leases: Vec<Lease>,
    /// Requests without an answer, the oldest first.
    requests: Vec<Request>,
}

/// A lease, on the holder's clock.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub struct Lease {
    /// The goal.
    pub goal: GoalId,
    /// The agent that granted it.
    pub grantor: AgentId,
    /// The number of the request that was granted; renewals do not change it.
    pub number: u32,
    /// When it was granted first.
    pub since_s: f64,
    /// When it ends.
    pub until_s: f64,
    /// Its duration from a request.
    pub lasts_s: f64,
}

#[derive(Debug, Clone, Copy, Hashed)]
struct Request {
    number: u32,
    grantor: AgentId,
    /// Without a goal, all leases of the grantor.
    goal: Option<GoalId>,
    sent_s: f64,
}

impl Holder {
    /// The leases.
    #[must_use]
    pub fn leases(&self) -> &[Lease] {
        &self.leases
    }

    /// The lease of a goal.
    #[must_use]
    pub fn lease(&self, goal: GoalId) -> Option<&Lease> {
        self.leases.iter().find(|lease| lease.goal == goal)
    }

    /// The leases of a grantor that end first, at most a number of them.
    #[must_use]
    pub fn ending_first(&self, grantor: AgentId, count: usize) -> Vec<Lease> {
        let own = self.leases.iter().filter(|lease| lease.grantor == grantor);
        let mut own: Vec<Lease> = own.copied().collect();
        own.sort_by(|one, other| one.until_s.total_cmp(&other.until_s));
        own.truncate(count);
        own
    }

    /// Whether the goal is held at a time: the lease has not ended.
    #[must_use]
    pub fn is_held(&self, goal: GoalId, now_s: f64) -> bool {
        let lease = self.lease(goal);
        lease.is_some_and(|lease| now_s < lease.until_s)
    }

    /// Notes a request for a goal, or to renew all leases of a grantor, that is sent now.
    pub fn request(&mut self, number: u32, grantor: AgentId, goal: Option<GoalId>, now_s: f64) {
        if self.requests.len() == MAX_REQUESTS {
            self.requests.remove(0);
        }
        self.requests.push(Request {
            number,
            grantor,
            goal,
            sent_s: now_s,
        });
    }

    /// From now on, no answer to an earlier request for a goal has an effect; its lease stays.
    pub fn forget_requests(&mut self, goal: GoalId) {
        self.requests.retain(|request| request.goal != Some(goal));
    }

    /// Takes a grant of a goal; returns whether it is held now. A grant that answers no request, or
    /// too late, changes nothing.
    pub fn accept(&mut self, from: AgentId, claim: Claim, lasts_s: f64, now_s: f64) -> bool {
        let Some(sent_s) = self.answered(from, claim.number, Some(claim.goal)) else {
            return self.is_held(claim.goal, now_s);
        };
        let is_held = self.is_held(claim.goal, now_s);
        let until_s = sent_s + lasts_s;
        let is_valid = (0.0..=MAX_LEASE_S).contains(&lasts_s) && now_s < until_s;
        if is_held || !is_valid {
            return is_held;
        }
        self.leases.retain(|lease| lease.goal != claim.goal);
        self.leases.push(Lease {
            goal: claim.goal,
            grantor: from,
            number: claim.number,
            since_s: now_s,
            until_s,
            lasts_s,
        });
        true
    }

    /// Takes the renewal of one lease.
    pub fn renew_one(&mut self, from: AgentId, claim: Claim, now_s: f64) {
        if let Some(sent_s) = self.answered(from, claim.number, Some(claim.goal)) {
            self.extend(from, Some(claim.goal), sent_s, now_s);
        }
    }

    /// Takes the renewal of all leases of a grantor.
    pub fn renew(&mut self, from: AgentId, number: u32, now_s: f64) {
        if let Some(sent_s) = self.answered(from, number, None) {
            self.extend(from, None, sent_s, now_s);
        }
    }

    /// Whether the answer to a renewal of all leases is that each has to be renewed.
    pub fn differs(&mut self, from: AgentId, number: u32) -> bool {
        self.answered(from, number, None).is_some()
    }

    /// Whether a request for a goal has not been answered.
    #[must_use]
    pub fn is_requested(&self, from: AgentId, claim: Claim) -> bool {
        self.requests.iter().any(|request| {
            let is_number = request.number == claim.number && request.grantor == from;
            is_number && request.goal == Some(claim.goal)
        })
    }

    /// Whether a message answers a request for a goal.
    pub fn is_answer(&mut self, from: AgentId, claim: Claim) -> bool {
        self.answered(from, claim.number, Some(claim.goal))
            .is_some()
    }

    /// Ends a lease; no grant that answers an earlier request has an effect from now on.
    pub fn release(&mut self, goal: GoalId) -> Option<Lease> {
        self.forget_requests(goal);
        let index = self.leases.iter().position(|lease| lease.goal == goal)?;
        Some(self.leases.remove(index))
    }

    /// Removes the leases that end before a time, and returns their goals.
    pub fn expire(&mut self, before_s: f64) -> Vec<GoalId> {
        let is_over = |lease: &Lease| lease.until_s <= before_s;
        let over = self.leases.iter().filter(|lease| is_over(lease));
        let over: Vec<GoalId> = over.map(|lease| lease.goal).collect();
        for goal in &over {
            self.release(*goal);
        }
        over
    }

    /// The request to renew all leases of a grantor; `None` without any.
    #[must_use]
    pub fn renewal(&self, grantor: AgentId, number: u32) -> Option<Renewal> {
        let leases = self.leases.iter();
        let own = leases.filter(|lease| lease.grantor == grantor);
        let (count, hash) = set_hash(own.map(|lease| lease.goal));
        (count > 0).then_some(Renewal {
            number,
            count,
            hash,
        })
    }

    /// When the request of this number was sent; it is forgotten.
    fn answered(&mut self, from: AgentId, number: u32, goal: Option<GoalId>) -> Option<f64> {
        let index = self.requests.iter().position(|request| {
            request.number == number && request.grantor == from && request.goal == goal
        })?;
        Some(self.requests.remove(index).sent_s)
    }

    /// Extends a lease, or all of a grantor, that were held when the request was sent and still are.
    fn extend(&mut self, from: AgentId, goal: Option<GoalId>, sent_s: f64, now_s: f64) {
        for lease in &mut self.leases {
            let is_meant = goal.is_none_or(|goal| goal == lease.goal);
            let was_held = lease.grantor == from && lease.since_s <= sent_s;
            let is_longer = sent_s + lease.lasts_s > lease.until_s;
            if is_meant && was_held && is_longer && now_s < lease.until_s {
                lease.until_s = sent_s + lease.lasts_s;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRANTOR: AgentId = AgentId::controller(1, 0);
    const OTHER: AgentId = AgentId::controller(1, 1);

    fn claim(number: u32) -> Claim {
        Claim {
            goal: GoalId::default(),
            number,
        }
    }

    /// A holder that sent request 1 at 0 s.
    fn holder() -> Holder {
        let mut holder = Holder::default();
        holder.request(1, GRANTOR, Some(claim(1).goal), 0.0);
        holder
    }

    #[test]
    fn a_lease_lasts_from_sending_the_request() {
        let mut holder = holder();
        assert!(holder.accept(GRANTOR, claim(1), 10.0, 4.0));
        assert!(holder.is_held(claim(1).goal, 9.9) && !holder.is_held(claim(1).goal, 10.0));
        assert_eq!(holder.expire(9.9), []);
        assert_eq!(holder.expire(10.0), [claim(1).goal]);
    }

    #[test]
    fn a_grant_that_answers_no_request_or_too_late_changes_nothing() {
        for (from, number, now_s) in [(OTHER, 1, 1.0), (GRANTOR, 2, 1.0), (GRANTOR, 1, 10.0)] {
            assert!(!holder().accept(from, claim(number), 10.0, now_s));
        }
        assert!(!holder().accept(GRANTOR, claim(1), f64::NAN, 1.0));
    }

    #[test]
    fn a_grant_that_answers_a_request_from_before_the_release_changes_nothing() {
        let mut holder = holder();
        holder.request(2, GRANTOR, Some(claim(2).goal), 0.5);
        assert!(holder.accept(GRANTOR, claim(1), 10.0, 1.0));
        assert!(holder.release(claim(1).goal).is_some());
        assert!(!holder.accept(GRANTOR, claim(2), 10.0, 2.0));
        assert!(!holder.accept(GRANTOR, claim(1), 10.0, 2.0));
    }

    #[test]
    fn a_renewal_extends_only_what_was_held_when_it_was_requested() {
        let mut holder = holder();
        holder.request(2, GRANTOR, None, 0.5);
        holder.accept(GRANTOR, claim(1), 10.0, 1.0);
        holder.renew(GRANTOR, 2, 1.5);
        assert!(!holder.is_held(claim(1).goal, 10.0));
        holder.request(3, GRANTOR, None, 5.0);
        holder.renew(GRANTOR, 3, 6.0);
        assert!(holder.is_held(claim(1).goal, 14.9) && !holder.is_held(claim(1).goal, 15.0));
        holder.request(4, GRANTOR, Some(claim(4).goal), 8.0);
        holder.renew_one(GRANTOR, claim(4), 16.0);
        assert!(!holder.is_held(claim(1).goal, 16.0));
    }

    #[test]
    fn the_number_of_requests_is_bounded() {
        let mut holder = holder();
        (2..1000).for_each(|number| holder.request(number, OTHER, None, 1.0));
        assert!(!holder.accept(GRANTOR, claim(1), 10.0, 2.0));
        assert_eq!(holder.requests.len(), MAX_REQUESTS);
    }
}
