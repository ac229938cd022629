//! Trade: goals go to the controller of the kind that can have them served.
//!
//! ```text
//! owner                      peer
//!       -- Offer (cost) -->       it requests estimates of a few of its robots
//!       <-- Price (number) --     the cost of the best one, and its probability; or Decline
//!       -- Transfer (number) -->  the owner owns the goal no longer, and votes for the peer
//!       <-- Entrust --            the peer is a candidate for it
//! ```
//!
//! Each transfer is one handover of the ownership, which is as safe as any: the peer owns the goal when a majority votes for
//! it, or, where controllers own goals alone, the previous owner. A swap is two transfers, each on its own.
//!
//! * [`offers`]: goals that this controller owns and offers; [`promises`]: what it has transferred, and whether it was served;
//! * [`tenders`]: goals of others that it has a price for.

mod offers;
mod promises;
mod tenders;
mod terms;

use super::context::Context;
use super::contracts::Contracts;
use super::ownership::Ownership;
use base::hashed::Hashed;
use brain::{AgentId, ContractMessage, GoalId, TradeMessage};
use offers::Offers;
use promises::Promises;
use tenders::Tenders;

/// The trade of a controller.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Trading {
    offers: Offers,
    promises: Promises,
    tenders: Tenders,
}

impl Trading {
    /// Offers goals, transfers them, and answers offers.
    pub(super) fn step(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        ownership: &mut Ownership,
    ) {
        self.promises.step(context, ownership);
        self.tenders.step(context);
        if context.settings.trade.is_none() {
            return;
        }
        for accepted in self.offers.conclude(context, contracts, &self.promises) {
            self.promises
                .transfer(context, contracts, ownership, accepted);
        }
        self.offers.make(context, contracts, &self.promises);
    }

    /// The controllers of the kind, or whether they vote, have changed: earlier prices count no more.
    pub(super) fn void_prices(&mut self) {
        self.tenders = Tenders::default();
        self.offers = Offers::default();
    }

    /// Forgets what controllers have promised that a person has removed.
    pub(super) fn forget_peers(&mut self, is_removed: impl Fn(AgentId) -> bool) {
        self.promises.forget_peers(is_removed);
    }

    /// Takes a message of another controller of its kind.
    pub(super) fn receive(
        &mut self,
        context: &mut Context,
        ownership: &mut Ownership,
        from: AgentId,
        (message, confidence): (TradeMessage, f64),
    ) {
        match message {
            TradeMessage::Offer(offer) => self.tenders.open(context, from, offer),
            TradeMessage::Price(price) => self.offers.take_price(from, price, confidence),
            TradeMessage::Decline(goal) => self.offers.take_decline(from, goal),
            TradeMessage::Transfer(transfer) => {
                self.tenders
                    .take_transfer(context, ownership, from, transfer);
            }
            TradeMessage::Dismiss(claim) => ownership.take_dismissal(context, from, claim),
            TradeMessage::Dismissed(claim) => Ownership::own_after(context, from, claim),
        }
    }

    /// Takes the answer of a robot to a request of an estimate; returns whether the message is one.
    pub(super) fn take_answer(
        &mut self,
        context: &Context,
        from: AgentId,
        (message, confidence): (&ContractMessage, f64),
    ) -> bool {
        match message {
            ContractMessage::Bid(bid) => self.tenders.take_bid(context, from, (*bid, confidence)),
            ContractMessage::Refuse(refusal) => self.tenders.take_refusal(context, from, refusal),
            _ => false,
        }
    }

    /// Another controller states that a goal has been served.
    pub(super) fn note_end(&mut self, context: &mut Context, from: AgentId, goal: GoalId) {
        self.promises.keep(context, from, goal);
    }

    /// Number of goals that it has transferred to others.
    pub(super) fn transfers(&self) -> u32 {
        self.promises.made
    }
}
