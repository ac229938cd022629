//! Messages between controllers by which a goal goes to the one that can have it served.

use super::goal_id::GoalId;
use super::lease::Claim;
use super::work::Task;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A message between controllers of a kind about a goal that one of them owns.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TradeMessage {
    /// From the owner of a goal to another controller: a request of a price.
    Offer(TradeOffer),
    /// The answer to it: the cost for which the sender would have the goal served. The confidence of its message is the
    /// probability that it is, as the robot bids.
    Price(Price),
    /// The answer to it: no price.
    Decline(GoalId),
    /// From the owner to the sender of a price: the receiver is to own the goal, which the sender owns no longer.
    Transfer(Transfer),
    /// From an owner to the controller that has transferred the goal to it: its vote is not needed any more, as each
    /// controller owns its goals alone. The number is that of the request by which it has voted.
    Dismiss(Claim),
    /// The answer to it, or to a request of a vote after it: it will not own the goal again.
    Dismissed(Claim),
}

/// A goal that is offered to another controller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct TradeOffer {
    /// The cost that a price has to be below by a factor, in seconds; `f32::MAX` if any is.
    pub cost_s: f32,
    /// The description of the goal.
    pub task: Task,
}

/// What it costs another controller to have a goal served.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Price {
    /// The goal.
    pub goal: GoalId,
    /// The number that its sender gave the price, which is different for each.
    pub number: u32,
    /// The cost of its best bid, as for awards, in seconds.
    pub cost_s: f32,
}

/// The transfer of a goal to another controller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Transfer {
    /// The goal.
    pub goal: GoalId,
    /// The number of the price that is accepted.
    pub price: u32,
    /// The number of the request by which the receiver has voted for the sender, which is released; 0 without one.
    pub lease: u32,
    /// The cost that the next price has to be below by a factor, in seconds.
    pub limit_s: f32,
}

impl TradeMessage {
    pub(super) fn urgency(&self) -> u8 {
        match self {
            Self::Offer(_) | Self::Decline(_) => 2,
            _ => 1,
        }
    }
}
