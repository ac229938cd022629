//! The goals for which controllers have called for bids.

use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalId;
use crate::io::work::Task;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// Maximum number of offers; the one that was called the longest ago is forgotten first.
const MAX_OFFERS: usize = 256;

/// An offer is forgotten if its call is not repeated within this time, in seconds.
const LIFE_S: f64 = 60.0;

/// The number of no call.
pub(super) const NO_CALL: u16 = u16::MAX;

/// All known offers.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Offers {
    /// By the times of their last calls, the oldest first.
    list: Vec<Offer>,
    /// Number of changes.
    pub(crate) version: u32,
}

/// A goal for which a controller has called for bids.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct Offer {
    pub(crate) task: Task,
    pub(crate) owner: AgentId,
    /// Number of the call.
    pub(crate) call: u16,
    /// Its deadline on the robot's clock.
    pub(crate) due_at_s: f64,
    called_s: f64,
}

impl Offer {
    pub(crate) fn new(task: Task, owner: AgentId, call: u16, now_s: f64) -> Self {
        Self {
            task,
            owner,
            call,
            due_at_s: now_s + f64::from(task.due_s),
            called_s: now_s,
        }
    }
}

impl Offers {
    /// Notes a call; returns whether it is new.
    pub(crate) fn put(&mut self, offer: Offer) -> bool {
        let known = self.take(offer.task.id);
        if self.list.len() == MAX_OFFERS {
            self.list.remove(0);
        }
        self.list.push(offer);
        let is_same = |known: &Offer| known.call == offer.call && known.owner == offer.owner;
        let is_new = !known.as_ref().is_some_and(is_same);
        self.version = self.version.wrapping_add(is_new.into());
        is_new
    }

    pub(crate) fn remove(&mut self, goal: GoalId) {
        let is_known = self.take(goal).is_some();
        self.version = self.version.wrapping_add(is_known.into());
    }

    fn take(&mut self, goal: GoalId) -> Option<Offer> {
        let index = self.list.iter().position(|offer| offer.task.id == goal)?;
        Some(self.list.remove(index))
    }

    pub(crate) fn get(&self, goal: GoalId) -> Option<&Offer> {
        self.list.iter().find(|offer| offer.task.id == goal)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Offer> {
        self.list.iter()
    }

    /// Forgets the offers that have not been repeated.
    pub(crate) fn expire(&mut self, now_s: f64) {
        self.list.retain(|offer| now_s < offer.called_s + LIFE_S);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::work::Work;

    fn offer(number: u32, now_s: f64) -> Offer {
        let id = GoalId {
            number,
            ..GoalId::default()
        };
        let task = Task {
            id,
            at_m: [0.0; 2],
            radius_m: 1.0,
            value: 1.0,
            service_s: 0.0,
            due_s: 5.0,
            work: Work::Visit,
            capability: 0,
        };
        Offer::new(task, AgentId::default(), 1, now_s)
    }

    #[test]
    fn a_repeated_call_is_no_new_offer_and_one_that_is_not_repeated_expires() {
        let mut offers = Offers::default();
        assert!(offers.put(offer(1, 0.0)) && offers.put(offer(2, 0.0)));
        assert!(!offers.put(offer(1, 40.0)));
        offers.expire(70.0);
        let left: Vec<u32> = offers.iter().map(|offer| offer.task.id.number).collect();
        assert_eq!(left, [1]);
    }

    #[test]
    fn the_number_of_offers_is_bounded() {
        let mut offers = Offers::default();
        for number in 0..1000 {
            offers.put(offer(number, f64::from(number)));
        }
        assert_eq!(offers.iter().count(), MAX_OFFERS);
        assert!(offers.get(offer(999, 0.0).task.id).is_some());
    }
}
