//! When a robot bids, and for what.

use super::ability::{Ability, Moment};
use super::assignee::Assignee;
use super::bidding::{Bidder, Estimate};
use super::offers::{NO_CALL, Offer};
use super::schedule::StandingBid;
use crate::io::contract::ContractMessage;
use crate::io::message::Message;
use crate::io::reason::Reason;
use alloc::vec::Vec;

impl Assignee {
    /// Bids for the best offer of each controller, unless the last bid still stands.
    pub(super) fn bid(&mut self, ability: &Ability, moment: &Moment) {
        let is_full = self.jobs.list.len() >= ability.max_goals;
        let versions = [self.offers.version, self.jobs.version];
        if is_full
            || self.is_out_of_service
            || self.offers.iter().next().is_none()
            || !self.schedule.is_turn(moment.percept, versions, self.now_s)
        {
            return;
        }
        let known = (&self.jobs, &self.failures);
        let Some(bidder) = Bidder::new(ability, known, moment, self.now_s) else {
            return;
        };
        let mut best: Vec<Estimate> = Vec::new();
        for offer in self.offers.iter() {
            let Ok(estimate) = bidder.estimate(offer) else {
                continue;
            };
            let mut others = best.iter_mut();
            match others.find(|other| other.offer.owner == offer.owner) {
                Some(other) if estimate.cost_s() < other.cost_s() => *other = estimate,
                Some(_) => {}
                None => best.push(estimate),
            }
        }
        for estimate in best {
            let Offer {
                owner, call, task, ..
            } = estimate.offer;
            let standing = self.schedule.bid_of(owner);
            let stands = standing
                .is_some_and(|bid| bid.stands(task.id, call, self.jobs.version, self.now_s));
            if !stands {
                self.send_bid(&estimate);
            }
        }
    }

    pub(super) fn estimate(
        &self,
        offer: &Offer,
        ability: &Ability,
        moment: &Moment,
    ) -> Result<Estimate, Reason> {
        if self.is_out_of_service {
            return Err(Reason::OutOfService);
        }
        let known = (&self.jobs, &self.failures);
        let bidder = Bidder::new(ability, known, moment, self.now_s);
        bidder.map_or(Err(Reason::Unreachable), |bidder| bidder.estimate(offer))
    }

    /// Answers what it would bid for a goal that the sender does not own: no award can accept that.
    pub(super) fn answer_estimate(&mut self, offer: Offer, ability: &Ability, moment: &Moment) {
        let (to, goal) = (offer.owner, offer.task.id);
        let is_known = self.finished.contains(goal) || self.jobs.get(goal).is_some();
        let estimate = if is_known {
            Err(Reason::Lease)
        } else {
            self.estimate(&offer, ability, moment)
        };
        match estimate {
            Ok(estimate) => {
                let number = self.numbers.draw();
                self.push_bid(&estimate, number);
            }
            Err(reason) => self.refuse(to, goal, NO_CALL.into(), reason),
        }
    }

    pub(super) fn send_bid(&mut self, estimate: &Estimate) {
        let Offer {
            owner, call, task, ..
        } = estimate.offer;
        let number = self.numbers.draw();
        self.holder
            .request(number, owner, Some(task.id), self.now_s);
        self.push_bid(estimate, number);
        let bid = StandingBid {
            goal: task.id,
            call,
            sent_s: self.now_s,
            jobs: self.jobs.version,
        };
        self.schedule.set_bid(owner, bid);
    }

    fn push_bid(&mut self, estimate: &Estimate, number: u32) {
        self.outbox.push(Message {
            confidence: estimate.confidence,
            ..Message::to(
                estimate.offer.owner,
                ContractMessage::Bid(estimate.bid(number)),
            )
        });
    }
}
