//! Goals that the controller owns and offers to others.
//!
//! It offers a goal without an assignee for which it has had no valid bid for a period of calls, or that a robot has lost, or
//! any of them if more than half of the maximum number of goals wait. A goal goes to the best price that is at most `gain` times what it has to be below,
//! and that the peer is trusted to keep: the share of its promises that it has kept, times the probability of its bid, is at
//! least `confidence`. Each transfer sets the cost that the next price has to be below, so that a goal moves a bounded number
//! of times.

use super::promises::Promises;
use super::terms::{Accepted, MIN_COST_S, PRICE_LIFE_S};
use crate::controller::context::{Context, short};
use crate::controller::contracts::{Contracts, REPEAT_S};
use crate::controller::ledger::owned::Owned;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, GoalId, Price, TradeMessage, TradeOffer};

/// Maximum number of offers per step.
const MAX_PER_STEP: usize = 2;

/// More failures count as this number of them.
const MAX_FAILURES: u16 = 16;

/// A goal is offered again after this time, in seconds.
const AGAIN_S: f64 = 10.0;

/// The offers whose prices have not all arrived.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Offers {
    open: Vec<Offer>,
}

/// A goal that is on offer to other controllers.
#[derive(Debug, Clone, Hashed)]
struct Offer {
    goal: GoalId,
    /// What a price is multiplied with has to be below; infinity if any price is.
    cost_s: f64,
    until_s: f64,
    /// The controllers that have not answered.
    awaited: Vec<AgentId>,
    prices: Vec<Priced>,
}

/// The price of a controller.
#[derive(Debug, Clone, Copy, Hashed)]
struct Priced {
    peer: AgentId,
    price: Price,
    /// Probability that the goal is served, as its robot bids.
    probability: f64,
}

impl Offers {
    /// Takes the price of a controller.
    pub(super) fn take_price(&mut self, peer: AgentId, price: Price, probability: f64) {
        let is_valid =
            (0.0..f32::MAX).contains(&price.cost_s) && (0.0..=1.0).contains(&probability);
        let Some(offer) = self.awaiting(peer, price.goal).filter(|_| is_valid) else {
            return;
        };
        offer.awaited.retain(|awaited| *awaited != peer);
        offer.prices.push(Priced {
            peer,
            price,
            probability,
        });
    }

    /// A controller has no price.
    pub(super) fn take_decline(&mut self, peer: AgentId, goal: GoalId) {
        if let Some(offer) = self.awaiting(peer, goal) {
            offer.awaited.retain(|awaited| *awaited != peer);
        }
    }

    fn awaiting(&mut self, peer: AgentId, goal: GoalId) -> Option<&mut Offer> {
        let mut open = self.open.iter_mut();
        open.find(|offer| offer.goal == goal && offer.awaited.contains(&peer))
    }

    /// Ends the offers that all have answered, or that are over; returns the best acceptable price of each.
    pub(super) fn conclude(
        &mut self,
        context: &Context,
        contracts: &Contracts,
        promises: &Promises,
    ) -> Vec<Accepted> {
        let is_over =
            |offer: &mut Offer| offer.awaited.is_empty() || context.now_s >= offer.until_s;
        let over: Vec<Offer> = self.open.extract_if(.., is_over).collect();
        let mut accepted: Vec<Accepted> = Vec::new();
        for offer in over {
            let is_tradable = context
                .ledger
                .get(offer.goal)
                .is_some_and(|owned| is_tradable(owned, context, contracts));
            let best = offer.best(
                context,
                |peer| {
                    let granted = accepted.iter().filter(|other| other.peer == peer).count();
                    promises.may_promise(peer, granted, context)
                },
                promises,
            );
            accepted.extend(best.filter(|_| is_tradable));
        }
        accepted
    }

    /// Offers goals to the controllers in range.
    pub(super) fn make(
        &mut self,
        context: &mut Context,
        contracts: &Contracts,
        promises: &Promises,
    ) {
        let now_s = context.now_s;
        let members = context.peers.members_of(context.own);
        let peers = members.filter(|peer| {
            promises.may_promise(*peer, 0, context) && !promises.is_resting(*peer, now_s)
        });
        let peers: Vec<AgentId> = peers.collect();
        if peers.is_empty() || !context.may_grant() {
            return;
        }
        let is_overloaded = is_overloaded(context);
        for _ in 0..MAX_PER_STEP {
            let goals = context.ledger.goals.iter();
            let due = goals.filter(|owned| {
                now_s >= owned.next_offer_s
                    && (is_overloaded || owned.failures > 0 || lacks_bids(owned, context))
                    && is_tradable(owned, context, contracts)
            });
            let next = due.min_by(|one, other| one.next_offer_s.total_cmp(&other.next_offer_s));
            let Some(owned) = next else {
                return;
            };
            let goal = owned.task.id;
            let own_s = contracts.lowest_cost_s(context, goal) * doubt(owned);
            let cost_s = own_s.min(owned.limit_s);
            self.open.retain(|offer| offer.goal != goal);
            self.open.push(Offer {
                goal,
                cost_s,
                until_s: now_s + PRICE_LIFE_S / 2.0,
                awaited: peers.clone(),
                prices: Vec::new(),
            });
            let Some(owned) = context.ledger.get_mut(goal) else {
                return;
            };
            owned.next_offer_s = now_s + AGAIN_S;
            let task = owned.task_at(now_s);
            let cost_s = short(cost_s.min(f32::MAX.into()));
            for peer in &peers {
                context.send(*peer, TradeMessage::Offer(TradeOffer { cost_s, task }));
            }
        }
    }
}

impl Offer {
    /// The lowest price, divided by its probability, that is acceptable.
    fn best(
        &self,
        context: &Context,
        may_promise: impl Fn(AgentId) -> bool,
        promises: &Promises,
    ) -> Option<Accepted> {
        let trade = context.settings.trade?;
        let acceptable = self.prices.iter().filter(|priced| {
            let is_gain =
                f64::from(priced.price.cost_s).max(MIN_COST_S) <= trade.gain * self.cost_s;
            let confidence = promises.share_kept(priced.peer) * priced.probability;
            is_gain && confidence >= trade.confidence && may_promise(priced.peer)
        });
        let best = acceptable.min_by(|one, other| {
            let cost_s = |priced: &Priced| f64::from(priced.price.cost_s) / priced.probability;
            let by_cost = cost_s(one).total_cmp(&cost_s(other));
            by_cost.then(one.peer.cmp(&other.peer))
        });
        best.map(|priced| Accepted {
            peer: priced.peer,
            price: priced.price,
        })
    }
}

/// Whether a goal can go to another controller: no robot holds a lease of it, and the controller has not planned it itself.
fn is_tradable(owned: &Owned, context: &Context, contracts: &Contracts) -> bool {
    let is_ready = owned.is_held(context.now_s) && context.now_s >= owned.ready_s;
    let is_waiting = owned.assigned.is_none() && contracts.is_free(owned.task.id);
    let is_planned = owned.task.id.issuer == context.own.into();
    let is_settled = owned.giver.is_none() && owned.is_open(context.now_s);
    is_ready && is_waiting && is_settled && !is_planned
}

/// Whether no robot has bid for it since a period of calls, although each could.
fn lacks_bids(owned: &Owned, context: &Context) -> bool {
    let now_s = context.now_s;
    let since_s = owned
        .called_s
        .map(|called_s| called_s.max(owned.without_bid_s));
    // Robots that were called alone for it have answered.
    let wait_s = REPEAT_S + 2.0 * context.settings.answer_s;
    owned.unserved(now_s).is_some() || since_s.is_some_and(|since_s| now_s >= since_s + wait_s)
}

/// The factor of the cost of bids for a goal that robots have lost: its probability halves each time, as for their own bids.
fn doubt(owned: &Owned) -> f64 {
    f64::from(1_u32 << owned.failures.min(MAX_FAILURES))
}

/// Whether more than half of the maximum number of goals wait for a robot.
fn is_overloaded(context: &Context) -> bool {
    let waiting = context.ledger.goals.iter().filter(|owned| {
        owned.assigned.is_none() && owned.is_held(context.now_s) && owned.is_open(context.now_s)
    });
    2 * waiting.count() > context.settings.max_goals as usize
}
