//! Messages between robots.

use super::agent_id::{AgentId, Receiver};
use super::contract::ContractMessage;
use super::goal_id::GoalId;
use super::lease::LeaseMessage;
use super::ownership::OwnershipMessage;
use super::trade::TradeMessage;
use super::work::lane::LaneMessage;
use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A message from one robot or controller to others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Message {
    /// The only receiver; without it, all that the message reaches.
    #[serde(default, skip_serializing_if = "Receiver::is_all")]
    #[schemars(with = "Option<AgentId>")]
    pub to: Receiver,
    /// Its content.
    pub about: About,
    /// Confidence of the sender, 0 to 1.
    pub confidence: f64,
}

impl Message {
    /// A message to all that it reaches, with full confidence.
    #[must_use]
    pub fn to_all(about: About) -> Self {
        Self::to(Receiver::All, about)
    }

    /// A message to one receiver, with full confidence.
    #[must_use]
    pub fn to(to: impl Into<Receiver>, about: impl Into<About>) -> Self {
        Self {
            to: to.into(),
            about: about.into(),
            confidence: 1.0,
        }
    }

    /// Its rank among the messages of a step, which a radio sends until it has sent its maximum: 0 is first.
    ///
    /// 0: leases end early without it; 1: another agent waits for it, and it may not be repeated; 2: offers, which are
    /// repeated; 3: information.
    #[must_use]
    pub fn urgency(&self) -> u8 {
        match &self.about {
            About::Lease(_) => 0,
            About::Contract(message) => message.urgency(),
            About::Ownership(message) => message.urgency(),
            About::Trade(message) => message.urgency(),
            About::Lane(message) => message.urgency(),
            About::Goal { .. } | About::Order { .. } => 1,
            About::Item { .. } | About::Sender { .. } => 3,
        }
    }
}

impl Hashed for Message {
    /// A message to all has the hash that messages had before they could have a receiver.
    fn add_to(&self, hash: &mut Hash) {
        let Self {
            to,
            about,
            confidence,
        } = self;
        (*about, *confidence).add_to(hash);
        if let Receiver::Agent(id) = to {
            id.add_to(hash);
        }
    }
}

/// The content of a message.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum About {
    /// An item.
    Item {
        /// Index of its kind in [`Body::item_kinds`](crate::Body::item_kinds).
        kind: u16,
        /// Its position in the world.
        at: Point,
        /// The observations behind the report.
        #[serde(default)]
        provenance: Provenance,
        /// Probability of its kind, given that there is an item: the confidence is that of an item of this kind. None
        /// from robots whose detectors are certain of kinds; receivers that are not then estimate it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        kind_share: Option<f32>,
    },
    /// The sender itself.
    Sender {
        /// Its position in the world.
        at: Point,
        /// Its heading: 0 along x, anticlockwise.
        heading_rad: f64,
        /// Number of measurements of its item detectors on the path to this pose.
        #[serde(default)]
        observations: u32,
    },
    /// A destination of the sender.
    Goal {
        /// Its id.
        id: GoalId,
        /// Its position in the world.
        at: Point,
        /// The status of the commitment.
        status: CommitmentStatus,
    },
    /// An order of a person. It is accepted only if its sender and the issuer of the goal are the
    /// operator.
    Order {
        /// The id of the goal.
        goal: GoalId,
        /// Its position in the world.
        at: Point,
        /// What to do with it.
        action: OrderAction,
    },
    /// A goal that a controller owns or awards.
    Contract(ContractMessage),
    /// Leases of robots and controllers.
    Lease(LeaseMessage),
    /// The ownership of a goal, from a controller to others.
    Ownership(OwnershipMessage),
    /// A mined lane.
    Lane(LaneMessage),
    /// The transfer of a goal, from a controller to another one.
    Trade(TradeMessage),
}

impl About {
    /// Whether it is between persons, controllers and robots of the economy of goals.
    #[must_use]
    pub fn is_of_economy(&self) -> bool {
        match self {
            Self::Contract(_)
            | Self::Lease(_)
            | Self::Ownership(_)
            | Self::Lane(_)
            | Self::Trade(_) => true,
            Self::Item { .. } | Self::Sender { .. } | Self::Goal { .. } | Self::Order { .. } => {
                false
            }
        }
    }
}

macro_rules! content {
    ($($about:ident($message:ty)),*) => {
        $(impl From<$message> for About {
            fn from(message: $message) -> Self {
                Self::$about(message)
            }
        })*
    };
}

content!(
    Contract(ContractMessage),
    Lease(LeaseMessage),
    Ownership(OwnershipMessage),
    Lane(LaneMessage),
    Trade(TradeMessage)
);

/// The observations of one item by one robot: they count once, whichever robot reports them, and
/// however often.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    JsonSchema,
    Hashed,
)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The observer.
    pub observer: AgentId,
    /// The number that the observer gave the item.
    pub track_id: u32,
    /// Number of observations: of two reports with the same track id, the one with more counts.
    pub observations: u32,
}

/// What a person orders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case")]
pub enum OrderAction {
    /// Visit the goal after those assigned before; move it if it is known.
    Assign,
    /// Remove the goal, wherever it is.
    Withdraw,
}

/// The status of a commitment to a destination.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case")]
pub enum CommitmentStatus {
    /// The sender is driving there: no other robot needs to go.
    Active,
    /// The sender has been there: no other robot needs to go.
    Done,
    /// The sender gave it up without having been there: other robots may go.
    Released,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_takes_at_most_64_bytes() {
        assert!(size_of::<Message>() <= 64, "{}", size_of::<Message>());
    }
}
