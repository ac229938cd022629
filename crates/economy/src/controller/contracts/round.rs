//! When the next round of awards begins.
//!
//! Bids do not take the awards of the last round into account until the robots have learned of these. A round begins when
//! every robot that won in the last one, or lost the goal for which it had bid, has bid again, refused or reported that it
//! is full; otherwise after the longest time that this takes.

use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::AgentId;

/// The pause after the awards of a round.
#[derive(Debug, Clone, Hashed)]
pub(super) struct Round {
    awaited: Vec<Awaited>,
    /// Until when, at the latest.
    until_s: f64,
}

/// A robot whose answer is awaited.
#[derive(Debug, Clone, Copy, Hashed)]
struct Awaited {
    robot: AgentId,
    /// Whether its next bid counts: that of a winner only when it has committed itself, as it may have sent one before it
    /// knew of its award.
    is_aware: bool,
}

impl Default for Round {
    fn default() -> Self {
        Self {
            awaited: Vec::new(),
            until_s: f64::NEG_INFINITY,
        }
    }
}

impl Round {
    /// Waits for the answer of a robot that has been awarded a goal.
    pub(super) fn await_winner(&mut self, robot: AgentId, until_s: f64) {
        self.add(robot, false, until_s);
    }

    /// Waits for the answer of a robot whose bid is void, or that has been called alone.
    pub(super) fn await_loser(&mut self, robot: AgentId, until_s: f64) {
        if !self.awaited.iter().any(|awaited| awaited.robot == robot) {
            self.add(robot, true, until_s);
        }
    }

    fn add(&mut self, robot: AgentId, is_aware: bool, until_s: f64) {
        self.end(robot);
        self.awaited.push(Awaited { robot, is_aware });
        self.until_s = until_s;
    }

    /// A robot has committed itself to its award.
    pub(super) fn committed(&mut self, robot: AgentId) {
        let mut awaited = self.awaited.iter_mut();
        if let Some(winner) = awaited.find(|awaited| awaited.robot == robot) {
            winner.is_aware = true;
        }
    }

    /// A robot has bid.
    pub(super) fn has_bid(&mut self, robot: AgentId) {
        self.awaited
            .retain(|awaited| awaited.robot != robot || !awaited.is_aware);
    }

    /// A robot has refused, or is full.
    pub(super) fn end(&mut self, robot: AgentId) {
        self.awaited.retain(|awaited| awaited.robot != robot);
    }

    /// Whether the next round can begin.
    pub(super) fn is_over(&self, now_s: f64) -> bool {
        self.awaited.is_empty() || now_s >= self.until_s
    }
}
