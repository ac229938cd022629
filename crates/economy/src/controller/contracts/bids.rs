//! The bids of robots. Each stays valid until it is replaced, its goal is awarded, or it is too old.

use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, Bid, GoalId};

/// A bid is valid for this time, in seconds: robots repeat it.
const LIFE_S: f64 = 10.0;

/// Maximum number of bids of one robot, and of all.
const MAX_OF_ROBOT: usize = 16;
const MAX_BIDS: usize = 4096;

/// All valid bids.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Bids {
    list: Vec<Standing>,
}

/// The bid of a robot.
#[derive(Debug, Clone, Copy, Hashed)]
pub(super) struct Standing {
    pub(super) robot: AgentId,
    pub(super) bid: Bid,
    pub(super) confidence: f64,
    received_s: f64,
}

impl Bids {
    pub(super) fn iter(&self) -> impl Iterator<Item = &Standing> {
        self.list.iter()
    }

    pub(super) fn get(&self, robot: AgentId, goal: GoalId) -> Option<&Standing> {
        let mut list = self.list.iter();
        list.find(|standing| standing.robot == robot && standing.bid.goal == goal)
    }

    /// The robots that have bid for a goal.
    pub(super) fn bidders(&self, goal: GoalId) -> Vec<AgentId> {
        let bids = self
            .list
            .iter()
            .filter(|standing| standing.bid.goal == goal);
        bids.map(|standing| standing.robot).collect()
    }

    /// Takes a bid; it replaces the one of the robot for the same goal.
    pub(super) fn put(&mut self, robot: AgentId, bid: Bid, confidence: f64, now_s: f64) {
        let is_same =
            |standing: &Standing| standing.robot == robot && standing.bid.goal == bid.goal;
        self.list.retain(|standing| !is_same(standing));
        let own = self.list.iter().filter(|standing| standing.robot == robot);
        if own.count() >= MAX_OF_ROBOT || self.list.len() >= MAX_BIDS {
            let oldest = self
                .list
                .iter()
                .position(|standing| standing.robot == robot);
            self.list.remove(oldest.unwrap_or(0));
        }
        self.list.push(Standing {
            robot,
            bid,
            confidence,
            received_s: now_s,
        });
    }

    /// Removes the bids of a robot: its path has changed.
    pub(super) fn remove_of(&mut self, robot: AgentId) {
        self.list.retain(|standing| standing.robot != robot);
    }

    pub(super) fn remove_for(&mut self, goal: GoalId) {
        self.list.retain(|standing| standing.bid.goal != goal);
    }

    pub(super) fn expire(&mut self, now_s: f64) {
        self.list
            .retain(|standing| now_s < standing.received_s + LIFE_S);
    }
}
