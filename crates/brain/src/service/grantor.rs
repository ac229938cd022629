//! The grantor's half of leases.
//!
//! A goal has one holder at a time. After a grant of duration L, the next grant waits, on the
//! grantor's own clock from sending the first, for
//!
//! ```text
//! L (1 + rho) / (1 - rho)        rho: maximum drift of any clock
//! ```
//!
//! A lease has the number of the request by which it was granted, also after renewals. A release names
//! it: one of an earlier lease, however late or repeated, has another number and no effect.
//!
//! The holder's L, counted on its clock from before the grant, takes at most L / (1 - rho), and
//! that takes at most (1 + rho) times as long on the grantor's clock.

use super::set_hash::set_hash;
use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalId;
use crate::io::lease::{Claim, Renewal};
use alloc::vec::Vec;
use base::hashed::Hashed;

/// The leases that an agent has granted.
#[derive(Debug, Clone, Default, Hashed)]
pub struct Grantor {
    grants: Vec<Grant>,
}

/// A granted lease, on the grantor's clock.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub struct Grant {
    /// The goal.
    pub goal: GoalId,
    /// The agent that may hold it.
    pub holder: AgentId,
    /// The number of the request that was granted; renewals do not change it.
    pub number: u32,
    /// The time for which another grant waits after this one.
    pub wait_s: f64,
    /// From when on another agent can have it.
    pub until_s: f64,
    /// Whether it is not renewed any more.
    pub is_withdrawn: bool,
}

/// The time for which a grantor waits after the grant of a lease, with clocks of a maximum drift.
#[must_use]
pub fn wait_s(lease_s: f64, max_drift: f64) -> f64 {
    lease_s * (1.0 + max_drift) / (1.0 - max_drift)
}

impl Grantor {
    /// All grants that may be held.
    #[must_use]
    pub fn grants(&self) -> &[Grant] {
        &self.grants
    }

    /// The grant of a goal that may be held.
    #[must_use]
    pub fn grant_of(&self, goal: GoalId) -> Option<&Grant> {
        self.grants.iter().find(|grant| grant.goal == goal)
    }

    /// Grants a goal; returns whether that is possible: no other agent can hold it.
    pub fn grant(&mut self, holder: AgentId, claim: Claim, wait_s: f64, now_s: f64) -> bool {
        let Claim { goal, number } = claim;
        if self.grant_of(goal).is_some() {
            return false;
        }
        self.grants.push(Grant {
            goal,
            holder,
            number,
            wait_s,
            until_s: now_s + wait_s,
            is_withdrawn: false,
        });
        true
    }

    /// Grants a goal that the same agent may hold already: from now on, the lease has the number of this request, so that a
    /// release that it sent before has no effect. A request from before the one that was granted grants nothing.
    pub fn grant_again(&mut self, holder: AgentId, claim: Claim, wait_s: f64, now_s: f64) -> bool {
        let mut grants = self.grants.iter_mut();
        let own = grants.find(|grant| grant.goal == claim.goal && grant.is_renewed_by(holder));
        let Some(grant) = own else {
            return self.grant(holder, claim, wait_s, now_s);
        };
        let is_older = claim.number.wrapping_sub(grant.number) > u32::MAX / 2;
        if !is_older {
            (grant.number, grant.wait_s) = (claim.number, grant.wait_s.max(wait_s));
            grant.extend(now_s);
        }
        !is_older
    }

    /// Renews one lease; returns whether the sender holds it.
    pub fn renew_one(&mut self, from: AgentId, claim: Claim, now_s: f64) -> bool {
        let mut grants = self.grants.iter_mut();
        let own = grants.find(|grant| grant.goal == claim.goal && grant.is_renewed_by(from));
        if let Some(grant) = own {
            grant.extend(now_s);
            return true;
        }
        false
    }

    /// Renews all leases of the sender; returns whether its list of them is the same as this one.
    pub fn renew(&mut self, from: AgentId, renewal: Renewal, now_s: f64) -> bool {
        let own = self.grants.iter().filter(|grant| grant.is_renewed_by(from));
        let is_same = set_hash(own.map(|grant| grant.goal)) == (renewal.count, renewal.hash);
        if is_same {
            let all = self.grants.iter_mut();
            let all = all.filter(|grant| grant.is_renewed_by(from));
            all.for_each(|grant| grant.extend(now_s));
        }
        is_same
    }

    /// Does not renew a lease any more; it ends by itself or by its release.
    pub fn withdraw(&mut self, goal: GoalId) {
        for grant in self.grants.iter_mut().filter(|grant| grant.goal == goal) {
            grant.is_withdrawn = true;
        }
    }

    /// Ends the lease of a goal that its holder does not need any more.
    pub fn end(&mut self, goal: GoalId) {
        self.remove(|grant| grant.goal == goal);
    }

    /// Takes the release or refusal of a lease by its holder; that of another lease has no effect.
    pub fn release(&mut self, from: AgentId, claim: Claim) -> Option<Grant> {
        self.remove(|grant| {
            grant.goal == claim.goal && grant.holder == from && grant.number == claim.number
        })
    }

    /// Removes the grants that no agent can hold any more, and returns them.
    pub fn expire(&mut self, now_s: f64) -> Vec<Grant> {
        let is_over = |grant: &&Grant| grant.until_s <= now_s;
        let over: Vec<Grant> = self.grants.iter().filter(is_over).copied().collect();
        self.grants.retain(|grant| !is_over(&grant));
        over
    }

    fn remove(&mut self, is_meant: impl Fn(&Grant) -> bool) -> Option<Grant> {
        let index = self.grants.iter().position(is_meant)?;
        Some(self.grants.remove(index))
    }
}

impl Grant {
    fn is_renewed_by(&self, holder: AgentId) -> bool {
        self.holder == holder && !self.is_withdrawn
    }

    fn extend(&mut self, now_s: f64) {
        self.until_s = self.until_s.max(now_s + self.wait_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOLDER: AgentId = AgentId::robot(0, 0);
    const OTHER: AgentId = AgentId::robot(0, 1);

    fn claim(number: u32) -> Claim {
        Claim {
            goal: GoalId::default(),
            number,
        }
    }

    /// A grantor that granted request 5 for 10 s at 0 s.
    fn grantor() -> Grantor {
        let mut grantor = Grantor::default();
        assert!(grantor.grant(HOLDER, claim(5), 10.0, 0.0));
        grantor
    }

    #[test]
    fn the_next_grant_waits_until_the_last_lease_has_ended() {
        let mut grantor = grantor();
        assert!(!grantor.grant(OTHER, claim(1), 10.0, 9.0));
        assert_eq!(grantor.expire(9.9).len(), 0);
        assert_eq!(grantor.expire(10.0).len(), 1);
        assert!(grantor.grant(OTHER, claim(1), 10.0, 10.0));
        assert!((wait_s(10.0, 0.1) - 12.222).abs() < 1e-3);
    }

    #[test]
    fn a_release_ends_the_lease_that_it_names_and_no_other() {
        for (from, number, ends) in [
            (HOLDER, 4, false),
            (HOLDER, 6, false),
            (OTHER, 5, false),
            (HOLDER, 5, true),
        ] {
            assert_eq!(grantor().release(from, claim(number)).is_some(), ends);
        }
    }

    #[test]
    fn a_release_counts_however_many_renewals_came_before() {
        let mut grantor = grantor();
        for number in 6..5000 {
            assert!(grantor.renew_one(HOLDER, claim(number), 1.0));
        }
        assert!(grantor.release(HOLDER, claim(5)).is_some());
    }

    #[test]
    fn a_request_that_is_granted_again_voids_the_release_of_the_one_before_it() {
        let mut grantor = grantor();
        assert!(grantor.grant_again(HOLDER, claim(6), 10.0, 4.0));
        assert!(!grantor.grant_again(HOLDER, claim(5), 10.0, 5.0));
        assert!(!grantor.grant_again(OTHER, claim(7), 10.0, 5.0));
        assert!(grantor.release(HOLDER, claim(5)).is_none());
        assert_eq!(grantor.expire(13.9).len(), 0);
        assert!(grantor.release(HOLDER, claim(6)).is_some());
    }

    #[test]
    fn a_withdrawn_lease_is_not_renewed() {
        let mut grantor = grantor();
        grantor.withdraw(claim(5).goal);
        assert!(!grantor.renew_one(HOLDER, claim(6), 1.0));
        assert!(!grantor.grant(OTHER, claim(1), 10.0, 1.0));
        assert!(grantor.release(HOLDER, claim(5)).is_some());
        assert!(grantor.grant(OTHER, claim(1), 10.0, 1.0));
    }

    #[test]
    fn a_renewal_never_creates_a_grant() {
        let mut grantor = grantor();
        assert!(!grantor.renew_one(OTHER, claim(7), 1.0));
        assert!(grantor.renew_one(HOLDER, claim(7), 1.0));
        assert_eq!(grantor.release(OTHER, claim(5)), None);
        let (count, hash) = set_hash(core::iter::once(claim(7).goal));
        let renewal = Renewal {
            number: 8,
            count,
            hash,
        };
        assert!(!grantor.renew(OTHER, renewal, 2.0));
        assert!(grantor.renew(HOLDER, renewal, 2.0));
        assert_eq!(grantor.expire(11.9).len(), 0);
        assert_eq!(grantor.expire(12.0).len(), 1);
        assert!(!grantor.renew_one(HOLDER, claim(9), 12.5));
    }
}
