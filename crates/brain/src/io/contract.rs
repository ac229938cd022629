//! Messages between persons, controllers and robots about goals: issues, offers, bids, awards, and what became of them.
//!
//! `docs/economy.md` describes the protocol: which message answers which.

use super::goal_id::GoalId;
use super::lease::Claim;
use super::reason::Reason;
use super::verdict::Verdict;
use super::work::Task;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A message about a goal that a controller owns, awards or has awarded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ContractMessage {
    /// From the operator to a controller: a goal that it is to own from now on.
    Issue(Task),
    /// From the operator to a controller: it has received what this reported of a goal.
    Acknowledge(GoalId),
    /// From the operator to a robot: whether it is in service. Out of service, it releases its goals,
    /// bids for none, and refuses awards.
    Service(bool),
    /// From a controller to robots: a request of a report.
    Query {},
    /// From a robot to controllers: its state.
    Report(Report),
    /// From a robot to the owner of a goal that it serves: its progress.
    Fitness(Fitness),
    /// From a controller to robots: a goal that they can bid for. A call to one robot requests an
    /// answer, a bid or a refusal.
    Call {
        /// The number that the caller gave the offer; it is the same when the call is repeated.
        number: u16,
        /// The goal.
        task: Task,
    },
    /// From a robot to the caller: its best bid.
    Bid(Bid),
    /// From the owner to a bidder: it is to serve the goal.
    Award(Award),
    /// From the receiver of an award: it serves the goal.
    Commit(Claim),
    /// From a robot: it does not serve the goal, and no award or call of this number changes that. From a controller to
    /// the operator: it does not own the goal.
    Refuse(Refusal),
    /// From a robot to the owner: it does not reach the goal. From a controller or robot to the
    /// operator: no robot can serve the goal, its owner has lost it, or the robot serves it no longer.
    Stuck(Refusal),
    /// From a robot or an owner: its lease has ended.
    Release(Claim),
    /// From a robot to the owner, until that withdraws the goal: the goal has been served.
    Done(Claim),
    /// From the owner to all: the goal is no longer on offer, except to the robot whose bid has this number, if any has.
    /// To its assignee: it is to release it.
    Withdraw(Claim),
    /// From a controller to a robot: a request of what it would bid for a goal that another controller owns. The answer is
    /// a bid that no award can accept, or a refusal.
    Estimate(Task),
}

impl ContractMessage {
    pub(super) fn urgency(&self) -> u8 {
        match self {
            Self::Call { .. } | Self::Estimate(_) | Self::Bid(_) => 2,
            Self::Query {} | Self::Report(_) | Self::Fitness(_) => 3,
            _ => 1,
        }
    }
}

/// The state of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Its position in the world, in metres.
    pub at_m: [f32; 2],
    /// The speed at which it drives to goals.
    pub speed_m_s: f32,
    /// Remaining fraction of the battery's capacity, 0 to 1.
    pub battery: f32,
    /// Number of goals that it serves, of all controllers.
    pub goals: u16,
    /// Number of goals that it can serve in addition: its free payload.
    pub payload: u16,
}

/// The progress of a robot towards a goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Fitness {
    /// The goal.
    pub goal: GoalId,
    /// Its verdict.
    pub verdict: Verdict,
    /// Expected time until it has been served.
    pub remaining_s: f32,
}

/// A bid of a robot for a goal. The confidence of its message is the probability that it serves it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Bid {
    /// The goal.
    pub goal: GoalId,
    /// The number that the robot gave the bid.
    pub number: u32,
    /// Time by which the robot's path and service become longer.
    pub time_s: f32,
    /// Time until it has served all of its goals and this one.
    pub total_s: f32,
    /// Energy for the additional path and service, as a fraction of the battery's capacity; 0 if unknown.
    pub energy: f32,
    /// The number of the call.
    pub call: u16,
}

/// The award of a goal, or the grant of its ownership.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Award {
    /// The goal.
    pub goal: GoalId,
    /// The number of the bid or request.
    pub number: u32,
    /// Duration of the lease, from sending the bid or request, on the holder's clock.
    pub lease_s: f32,
}

/// Why a robot or a controller does not serve a goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Refusal {
    /// The goal.
    pub goal: GoalId,
    /// The number of the bid or of the lease; of a refused call, that of the call.
    pub number: u32,
    /// Why.
    pub reason: Reason,
}
