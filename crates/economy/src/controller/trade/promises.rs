//! What other controllers have promised by their prices, and whether they have kept it.
//!
//! A promise is kept when its goal has been served, and broken when it has not long after the time that was promised. The share
//! of kept promises is the mean of a beta distribution,
//!
//! ```text
//! share = (2 x 0.9 + kept) / (2 + kept + broken)
//! ```
//!
//! (Jøsang and Ismail, *The beta reputation system*, 2002). A controller may hold goals that it has not served: 5 at the start,
//! divided by the number of other controllers, at least 1. Each promise that it keeps doubles that, and each that it breaks takes
//! one doubling back. So one that promises everything and serves nothing gets at most five goals of up to five others together,
//! and one of each of more. One that does not take a goal, or returns it, gets none for a time, each time for longer. A broken
//! promise is forgiven after a time, and a goal whose deadline has passed is held no longer.

use super::terms::{Accepted, MIN_COST_S, PRICE_LIFE_S};
use crate::controller::context::{Context, short};
use crate::controller::contracts::Contracts;
use crate::controller::ownership::Ownership;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, GoalId, OwnershipMessage, TradeMessage, Transfer};

/// Goals of all others together that a controller may hold if it has kept no promise, and how often that is doubled at most.
const UNPROVEN: usize = 5;
const MAX_DOUBLINGS: usize = 6;

/// Weight of the initial share, in promises, and its value.
const PRIOR_WEIGHT: f64 = 2.0;
const INITIAL: f64 = 0.9;

/// A promise is broken after this multiple of the cost, and more, in seconds: the robot may serve others before.
const LATE_FACTOR: f64 = 4.0;
const LATE_S: f64 = 120.0;

/// A controller that returns a goal gets none for this time, in seconds; each further return doubles it, up to a maximum.
const MIN_REST_S: f64 = 20.0;
const MAX_REST_S: f64 = 320.0;

/// A broken promise is forgiven after this time, in seconds, one after the other.
const FORGIVEN_S: f64 = 300.0;

/// A transfer that has had no effect is repeated after this time, in seconds.
const RETRY_S: f64 = 1.0;

#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Promises {
    records: Vec<Record>,
    open: Vec<Promise>,
    /// Number of transfers.
    pub(super) made: u32,
}

/// What a controller has kept, and broken, and until when it gets no goal.
#[derive(Debug, Clone, Copy, Hashed)]
struct Record {
    peer: AgentId,
    kept: u32,
    broken: u32,
    rest_s: f64,
    until_s: f64,
    /// When the next broken promise is forgiven.
    forgiven_s: f64,
}

/// A goal that has been transferred.
#[derive(Debug, Clone, Copy, Hashed)]
struct Promise {
    peer: AgentId,
    transfer: Transfer,
    made_s: f64,
    /// Until when it is to be kept, and whether it is broken; and the deadline of the goal.
    until_s: f64,
    due_at_s: f64,
    is_broken: bool,
    /// When the transfer is sent again; infinity once the peer is a candidate.
    next_s: f64,
}

impl Promises {
    /// The share of its promises that a controller has kept.
    pub(super) fn share_kept(&self, peer: AgentId) -> f64 {
        let [kept, broken] = self.counts(peer).map(f64::from);
        (PRIOR_WEIGHT * INITIAL + kept) / (PRIOR_WEIGHT + kept + broken)
    }

    /// Whether a controller may promise another goal, with a number of further ones.
    pub(super) fn may_promise(&self, peer: AgentId, further: usize, context: &Context) -> bool {
        let others = context.settings.count.saturating_sub(1) as usize;
        let held = self.open.iter().filter(|promise| promise.peer == peer);
        let [kept, broken] = self.counts(peer).map(|count| count as usize);
        let unproven = (UNPROVEN / others.max(1)).max(1);
        let most = unproven << kept.saturating_sub(broken).min(MAX_DOUBLINGS);
        held.count() + further < most
    }

    /// Whether a controller that has returned a goal gets none at a time.
    pub(super) fn is_resting(&self, peer: AgentId, now_s: f64) -> bool {
        let mut records = self.records.iter();
        records.any(|record| record.peer == peer && now_s < record.until_s)
    }

    fn counts(&self, peer: AgentId) -> [u32; 2] {
        let mut records = self.records.iter();
        let record = records.find(|record| record.peer == peer);
        record.map_or([0, 0], |record| [record.kept, record.broken])
    }

    /// Forgets controllers that a person has removed.
    pub(super) fn forget_peers(&mut self, is_removed: impl Fn(AgentId) -> bool) {
        self.open.retain(|promise| !is_removed(promise.peer));
        self.records.retain(|record| !is_removed(record.peer));
    }

    /// Transfers a goal for the price that is accepted.
    pub(super) fn transfer(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        ownership: &mut Ownership,
        Accepted { peer, price }: Accepted,
    ) {
        let (goal, now_s) = (price.goal, context.now_s);
        let cost_s = f64::from(price.cost_s).max(MIN_COST_S);
        let due_at_s = context
            .ledger
            .get(goal)
            .map_or(f64::INFINITY, |it| it.due_at_s);
        let lease = ownership.transfer(context, contracts, (goal, peer), PRICE_LIFE_S);
        let transfer = Transfer {
            goal,
            price: price.number,
            lease,
            limit_s: short(cost_s),
        };
        context.send(peer, TradeMessage::Transfer(transfer));
        self.made = self.made.saturating_add(1);
        self.open.push(Promise {
            peer,
            transfer,
            made_s: now_s,
            until_s: now_s + LATE_S + LATE_FACTOR * cost_s,
            due_at_s,
            is_broken: false,
            next_s: now_s + RETRY_S,
        });
    }

    /// Repeats transfers without an effect, and notes promises that are broken, and goals that are back.
    pub(super) fn step(&mut self, context: &mut Context, ownership: &Ownership) {
        let now_s = context.now_s;
        let is_back = |promise: &mut Promise| {
            let goal = promise.transfer.goal;
            if ownership.votes_for(goal) == Some(promise.peer) {
                promise.next_s = f64::INFINITY;
            }
            context.ledger.get(goal).is_some()
        };
        let back: Vec<Promise> = self.open.extract_if(.., is_back).collect();
        for promise in back {
            let record = self.record(promise.peer);
            // Several that are back at a time have one cause.
            if now_s >= record.until_s {
                record.rest_s = (2.0 * record.rest_s).clamp(MIN_REST_S, MAX_REST_S);
                record.until_s = now_s + record.rest_s;
            }
        }
        for index in 0..self.open.len() {
            let promise = &mut self.open[index];
            let peer = promise.peer;
            if now_s >= promise.next_s && now_s < promise.made_s + PRICE_LIFE_S {
                promise.next_s = now_s + RETRY_S;
                context.send(peer, TradeMessage::Transfer(promise.transfer));
            }
            if now_s >= promise.until_s.min(promise.due_at_s) && !promise.is_broken {
                promise.is_broken = true;
                let record = self.record(peer);
                record.broken += 1;
                record.forgiven_s = now_s + FORGIVEN_S;
            }
        }
        self.open.retain(|promise| now_s < promise.due_at_s);
        let due = self.records.iter_mut();
        for record in due.filter(|it| it.broken > 0 && now_s >= it.forgiven_s) {
            record.broken -= 1;
            record.forgiven_s = now_s + FORGIVEN_S;
        }
    }

    /// A goal has been served, as a controller states: it has kept its promise, unless another one had promised that.
    pub(super) fn keep(&mut self, context: &mut Context, from: AgentId, goal: GoalId) {
        let mut open = self.open.iter();
        let index = open.position(|promise| promise.transfer.goal == goal);
        let Some(promise) = index.map(|index| self.open.remove(index)) else {
            return;
        };
        let record = self.record(promise.peer);
        record.broken = record.broken.saturating_sub(promise.is_broken.into());
        if promise.peer == from {
            (record.kept, record.rest_s) = (record.kept + 1, 0.0);
        }
        if context.votes_needed() == 0 {
            // The controller from which it had the goal has promised that to another, too.
            let members = context.peers.members_of(context.own);
            let others: Vec<AgentId> = members.filter(|other| *other != from).collect();
            for other in others {
                context.send(other, OwnershipMessage::Ended(goal));
            }
        }
    }

    fn record(&mut self, peer: AgentId) -> &mut Record {
        let known = self.records.iter().position(|record| record.peer == peer);
        let index = known.unwrap_or_else(|| {
            self.records.push(Record {
                peer,
                kept: 0,
                broken: 0,
                rest_s: 0.0,
                until_s: f64::NEG_INFINITY,
                forgiven_s: f64::INFINITY,
            });
            self.records.len() - 1
        });
        &mut self.records[index]
    }
}
